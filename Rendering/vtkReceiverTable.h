// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkReceiverTable
 * @brief the receivers of a prop, for a shader that finds a fragment's own one among them
 *
 * Two buffer textures: the words of a penumbra::ReceiverGrid, which says which receivers are near a
 * point (GL_R32UI), and a record of each receiver (GL_RGBA32F). They are in a frame of their own,
 * GetOrigin() and GetUnit(), in which the receivers' numbers are near 1: no frame of the view
 * changes it.
 *
 * A record has RecordTexels texels; D is a row of what takes a place to (u, v, h) of the receiver,
 * with h = 0 on its plane, and b is its corner in single precision:
 * - (Du, b.x), (Dv, b.y), (Dh, b.z);
 * - the (u, v, h) of b itself, which rounding leaves; 1 for the lower left half of a parallelogram,
 *   else NoLimit, negative for windows of other receivers, which are preferred to these;
 * - the region of the prop's texture: where (u, v) = (0, 0) and how far it is to (1, 1);
 * - the ambient radiance, and which side of the plane the texels are for: SeenSide of the record;
 * - the reflectance, and the record's MiddleLight;
 * - (k, 1) for a plane that stands for a surface, which is projected onto it by k
 *   (penumbra::RegisteredProjection); else 0.
 */
#ifndef vtkReceiverTable_h
#define vtkReceiverTable_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "ReceiverFrame.h"
#include "vtkNew.h" // for vtkNew
#include "vtkObject.h"
#include "vtkWeakPointer.h" // for vtkWeakPointer

#include <cstdint>  // for words
#include <optional> // for centres of projection
#include <vector>   // for records

class vtkOpenGLBufferObject;
class vtkOpenGLRenderWindow;
class vtkTextureObject;

class PENUMBRARENDERING_EXPORT vtkReceiverTable : public vtkObject
{
public:
  static vtkReceiverTable* New();
  vtkTypeMacro(vtkReceiverTable, vtkObject)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  static constexpr int RecordTexels = 8;
  /// Far more than u + v is of any receiver.
  static constexpr float NoLimit = 1e9f;

  /// A receiver, and where its texels are.
  struct Record
  {
    penumbra::Parallelogram Base;
    bool IsTriangle = false;               ///< the lower left half is all of it
    bool IsHalf = false;                   ///< of its region, only the lower left half is its own
    bool IsWindow = false;                 ///< it is a part of another receiver, with finer texels
    std::optional<glm::dvec4> ProxyCentre; ///< see penumbra::Receiver
    glm::vec4 Place{ 0.0f };               ///< origin and size, in texture coordinates
    glm::vec3 Ambient{ 0.0f };
    glm::vec3 Reflectance{ 0.0f };
    /// Where the texels are seen from: 1 for the side where h > 0, -1 for the other one, twice that
    /// if another record has the other side's; 0: from everywhere.
    float SeenSide = 0.0f;
    /// The mean of what arrives at the receiver's middle, irradiance over pi, were nothing in the
    /// way.
    float MiddleLight = 0.0f;

    bool operator==(const Record& other) const;
  };

  /**
   * Make the table, if it is not that of these receivers already. False, after vtkErrorMacro, if
   * OpenGL refuses.
   */
  bool Update(vtkOpenGLRenderWindow* window, const std::vector<Record>& records);

  ///@{
  /**
   * The frame: (x - origin) / unit.
   */
  const glm::dvec3& GetOrigin() const { return this->Origin; }
  double GetUnit() const { return this->Unit; }
  ///@}

  ///@{
  /**
   * What takes places of the frame to the grid's box, [0, 1] along each axis: place * scale +
   * offset; and how many cells the outermost grid has along each axis.
   */
  const glm::dvec3& GetGridScale() const { return this->GridScale; }
  const glm::dvec3& GetGridOffset() const { return this->GridOffset; }
  const glm::ivec3& GetGridCells() const { return this->GridCells; }
  ///@}

  ///@{
  /**
   * The buffer textures.
   */
  vtkTextureObject* GetRecords() { return this->RecordTexture; }
  vtkTextureObject* GetGrid() { return this->GridTexture; }
  ///@}

  /**
   * The bytes that they take.
   */
  std::size_t GetBytes() const { return this->Bytes; }

  /**
   * Free them.
   */
  void ReleaseGraphicsResources();

protected:
  vtkReceiverTable();
  ~vtkReceiverTable() override;

private:
  vtkReceiverTable(const vtkReceiverTable&) = delete;
  void operator=(const vtkReceiverTable&) = delete;

  void ChooseFrame();
  std::vector<glm::vec4> MakeRecords() const;
  std::vector<std::uint32_t> MakeGrid();

  vtkWeakPointer<vtkOpenGLRenderWindow> Window;
  vtkNew<vtkOpenGLBufferObject> RecordBuffer, GridBuffer;
  vtkNew<vtkTextureObject> RecordTexture, GridTexture;
  std::vector<Record> Records;
  glm::dvec3 Origin{ 0.0 };
  double Unit = 1.0;
  glm::dvec3 GridScale{ 1.0 }, GridOffset{ 0.0 };
  glm::ivec3 GridCells{ 1 };
  std::size_t Bytes = 0;
};

#endif
