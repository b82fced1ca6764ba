// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "vtkReceiverTable.h"

#include "OpenGLErrors.h"
#include "ReceiverGrid.h"
#include "ScreenMap.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLBufferObject.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkTextureObject.h"

#include <algorithm>
#include <cmath>
#include <limits>

vtkStandardNewMacro(vtkReceiverTable);

namespace
{

bool IsSame(const penumbra::Parallelogram& a, const penumbra::Parallelogram& b)
{
  return a.Corner == b.Corner && a.EdgeX == b.EdgeX && a.EdgeY == b.EdgeY;
}

/// The receiver's own part of its parallelogram; nothing for what stands for a surface, which may
/// be anywhere.
penumbra::ReceiverGrid::Polygon MakePolygon(const vtkReceiverTable::Record& record)
{
  if (record.ProxyCentre)
  {
    return {};
  }
  const penumbra::Parallelogram& base = record.Base;
  penumbra::ReceiverGrid::Polygon polygon = { base.Corner, base.Corner + base.EdgeX,
    base.Corner + base.EdgeX + base.EdgeY, base.Corner + base.EdgeY };
  if (record.IsTriangle)
  {
    polygon.erase(polygon.begin() + 2);
  }
  return polygon;
}

template <typename T>
bool UploadTexture(const std::vector<T>& texels, int vtkType, vtkOpenGLRenderWindow* window,
  vtkOpenGLBufferObject* buffer, vtkTextureObject* texture)
{
  penumbra::ForgetOpenGLErrors();
  return buffer->Upload(texels, vtkOpenGLBufferObject::TextureBuffer) &&
    !penumbra::HasOpenGLError() &&
    penumbra::MakeTextureOfBuffer(
      texture, window, buffer, static_cast<int>(texels.size()), vtkType);
}

} // namespace

bool vtkReceiverTable::Record::operator==(const Record& other) const
{
  return IsSame(this->Base, other.Base) && this->IsTriangle == other.IsTriangle &&
    this->IsHalf == other.IsHalf && this->IsWindow == other.IsWindow &&
    this->ProxyCentre == other.ProxyCentre && this->Place == other.Place &&
    this->Ambient == other.Ambient && this->Reflectance == other.Reflectance &&
    this->SeenSide == other.SeenSide && this->MiddleLight == other.MiddleLight;
}

vtkReceiverTable::vtkReceiverTable() = default;

vtkReceiverTable::~vtkReceiverTable() = default;

bool vtkReceiverTable::Update(vtkOpenGLRenderWindow* window, const std::vector<Record>& records)
{
  if (this->Window == window && this->Bytes > 0 && records == this->Records)
  {
    return true;
  }
  this->ReleaseGraphicsResources();
  this->Window = window;
  this->Records = records;
  this->ChooseFrame();
  const std::vector<glm::vec4> texels = this->MakeRecords();
  const std::vector<std::uint32_t> words = this->MakeGrid();
  if (!UploadTexture(texels, VTK_FLOAT, window, this->RecordBuffer, this->RecordTexture) ||
    !UploadTexture(words, VTK_UNSIGNED_INT, window, this->GridBuffer, this->GridTexture))
  {
    vtkErrorMacro("OpenGL refused buffer textures of "
      << texels.size() << " and " << words.size() << " texels, which say where the "
      << records.size()
      << " planar receivers of a surface are. It is drawn without shadows; divide it.");
    this->ReleaseGraphicsResources();
    return false;
  }
  this->Bytes = texels.size() * sizeof(glm::vec4) + words.size() * sizeof(std::uint32_t);
  return true;
}

void vtkReceiverTable::ChooseFrame()
{
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const Record& record : this->Records)
  {
    const penumbra::Parallelogram& base = record.Base;
    for (const glm::dvec3& corner : { base.Corner, base.Corner + base.EdgeX,
           base.Corner + base.EdgeY, base.Corner + base.EdgeX + base.EdgeY })
    {
      low = glm::min(low, corner);
      high = glm::max(high, corner);
    }
  }
  this->Origin = 0.5 * low + 0.5 * high;
  const glm::dvec3 extent = 0.5 * high - 0.5 * low;
  this->Unit = std::max({ extent.x, extent.y, extent.z });
}

std::vector<glm::vec4> vtkReceiverTable::MakeRecords() const
{
  std::vector<glm::vec4> texels;
  texels.reserve(RecordTexels * this->Records.size());
  for (const Record& record : this->Records)
  {
    const penumbra::ReceiverFrame frame(record.Base, penumbra::ReceiverFrame::Side::Front);
    const glm::dmat4 rows = glm::transpose(frame.GetWorldToFrame());
    const glm::vec3 corner((record.Base.Corner - this->Origin) / this->Unit);
    for (int i = 0; i < 3; ++i)
    {
      texels.emplace_back(glm::vec3(glm::dvec3(rows[i]) * this->Unit), corner[i]);
    }
    const glm::dvec3 rest = frame.ToFrame(this->Origin + this->Unit * glm::dvec3(corner));
    const float limit = record.IsHalf ? 1.0f : NoLimit;
    texels.emplace_back(glm::vec3(rest), record.IsWindow ? -limit : limit);
    texels.push_back(record.Place);
    texels.emplace_back(record.Ambient, record.SeenSide);
    texels.emplace_back(record.Reflectance, record.MiddleLight);
    texels.emplace_back(0.0f);
    if (record.ProxyCentre)
    {
      const glm::dvec4 sample = frame.GetWorldToFrame() * *record.ProxyCentre;
      texels.back() = glm::vec4(glm::dvec3(sample.x, sample.y, sample.w) / sample.z, 1.0);
    }
  }
  return texels;
}

std::vector<std::uint32_t> vtkReceiverTable::MakeGrid()
{
  std::vector<penumbra::ReceiverGrid::Polygon> polygons;
  for (const Record& record : this->Records)
  {
    polygons.push_back(MakePolygon(record));
  }
  const penumbra::ReceiverGrid grid(polygons);
  this->GridScale = this->Unit / grid.GetSize();
  this->GridOffset = (this->Origin - grid.GetLow()) / grid.GetSize();
  this->GridCells = grid.GetCells();
  return grid.GetTable();
}

void vtkReceiverTable::ReleaseGraphicsResources()
{
  if (this->Window)
  {
    this->RecordTexture->ReleaseGraphicsResources(this->Window);
    this->GridTexture->ReleaseGraphicsResources(this->Window);
    this->RecordBuffer->ReleaseGraphicsResources();
    this->GridBuffer->ReleaseGraphicsResources();
  }
  this->Window = nullptr;
  this->Bytes = 0;
}

void vtkReceiverTable::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Receivers: " << this->Records.size() << "\n";
  os << indent << "Bytes: " << this->Bytes << "\n";
}
