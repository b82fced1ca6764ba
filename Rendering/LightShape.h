// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What all lights have in common.
 */
#ifndef LightShape_h
#define LightShape_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "ReceiverFrame.h"

#include "Vectors.h"

#include <memory>
#include <vector>

namespace penumbra
{

/**
 * A place on a light. The samples of a light stand for equal shares of it, but for those of cells
 * (Emission::Cells), each of which brings its own.
 */
struct LightSample
{
  glm::dvec3 Place{ 0.0 };  ///< world coordinates
  bool IsDirection = false; ///< Place is a direction, towards an emitter that is infinitely far
  /// Of Emission::Cells alone: the unit normal of the cell, and radiance times area that the sample
  /// would stand for if it were the only one.
  glm::dvec3 Normal{ 0.0 };
  glm::dvec3 Power{ 0.0 };
  /// How far polygons with the cell's vertices, triangulated in whatever way, may be from Place.
  double Unevenness = 0.0;
};

/**
 * An upper bound of the solid angle of a surface of the given area, in the box from `low` to
 * `high`, from anywhere on a parallelogram: area / distance^2, at most 4 pi.
 */
PENUMBRARENDERING_EXPORT double BoundSolidAngle(
  double area, const glm::dvec3& low, const glm::dvec3& high, const Parallelogram& receiver);

/// The distance between the boxes around a parallelogram and from `low` to `high`.
PENUMBRARENDERING_EXPORT double BoundDistance(
  const glm::dvec3& low, const glm::dvec3& high, const Parallelogram& receiver);

/// Points, or directions to points at infinity, in world coordinates.
struct LightHull
{
  std::vector<glm::dvec3> Points;
  bool AreDirections = false;
};

/// How a sample's light depends on the direction d from the receiver to it, apart from the
/// receiver's own cosine.
enum class Emission
{
  Area,  ///< |axis . d| / |d|^4: a diffuse surface whose normal is the axis
  Line,  ///< |axis x d| / |d|^4: a thin diffuse cylinder around the axis
  Point, ///< 1 / |d|^3: the same in all directions
  Cells  ///< as Area, with the sample's own normal and power
};

class PolygonLight;

/// A polygon that emits diffusely, and its radiance, W sr^-1 m^-2.
struct EmittingPolygon
{
  const PolygonLight* Polygon;
  glm::dvec3 Radiance;
};

/**
 * A light: an emitter's shape, its radiance, and the three things that a bake asks of it: what is
 * in front of a receiver, what it sends where nothing blocks it (the closed form), and samples.
 * Lights are values; Light holds one of any kind.
 */
class PENUMBRARENDERING_EXPORT LightShape
{
public:
  virtual ~LightShape() = default;

  /// What is emitted, to the front or to both sides; the unit is the kind's.
  glm::dvec3 Radiance{ 1.0 };
  /// Whether a surface emits to both sides; nothing to other kinds.
  bool TwoSided = false;
  /// How far the light's coordinates may be off by the rounding of their type, along each axis.
  glm::dvec3 Rounding{ 0.0 };

  virtual std::unique_ptr<LightShape> Clone() const = 0;

  /// False for a light with nothing that emits (or with coordinates that are not finite).
  virtual bool IsValid() const = 0;

  /// The light after an affine map: `matrix` with the translation in its last column.
  virtual std::unique_ptr<LightShape> Transform(const glm::dmat4& matrix) const = 0;

  /**
   * What is left of the light on the positive side of the plane through `point` with the unit
   * `normal`: what a receiver in that plane can see (H&H 1997, 3.6). Not valid if nothing is.
   */
  virtual std::unique_ptr<LightShape> Clip(
    const glm::dvec3& point, const glm::dvec3& normal) const = 0;

  /// The same light for one receiver. Where cells emit to both sides, each of its cells has one
  /// side, which the receiver sees; other lights stay as they are.
  virtual std::unique_ptr<LightShape> Face(const Parallelogram& /*receiver*/) const
  {
    return this->Clone();
  }

  /// Whether light can leave towards the point.
  virtual bool Faces(const glm::dvec3& point) const = 0;

  /// Points whose convex hull holds the light.
  virtual LightHull GetHull() const = 0;

  /**
   * The unoccluded light at a point x with the unit normal `normal`: irradiance over pi, as a
   * multiple of Radiance. Where the light is diffuse, that is the form factor, in [0, 1]. What is
   * below the horizon of x is left out.
   */
  virtual double FormFactor(const glm::dvec3& x, const glm::dvec3& normal) const = 0;

  /// The same with Radiance, in its three components.
  virtual glm::dvec3 Irradiance(const glm::dvec3& x, const glm::dvec3& normal) const
  {
    return this->Radiance * this->FormFactor(x, normal);
  }

  /// Area, length or solid angle: what decides, where no light arrives, whether there is any.
  virtual double GetMeasure() const = 0;

  /// An upper bound of the solid angle of the light from any point of the parallelogram, 0 if it
  /// has none.
  virtual double GetSolidAngleBound(const Parallelogram& receiver) const = 0;

  /**
   * An upper bound of Irradiance(), in its three components, anywhere on the parallelogram. By
   * default that of a flat diffuse surface: its form factor is at most area / distance^2 over pi,
   * times both cosines.
   */
  virtual glm::dvec3 GetIrradianceBound(const Parallelogram& receiver) const;

  /// How many times as long as wide the unit square becomes on the light: strata follow it.
  virtual double GetAspect() const { return 1.0; }

  /// As many samples as the light needs for the points of a pattern on the unit square; lights that
  /// have no extent need one.
  virtual std::vector<LightSample> TakeSamples(const std::vector<glm::dvec2>& pattern) const = 0;

  virtual Emission GetEmission() const = 0;
  /// Whether all samples are of the light's hue: the components then have one visibility.
  virtual bool HasOneHue() const { return true; }
  /// The unit vector that GetEmission() speaks of, in world coordinates.
  virtual glm::dvec3 GetAxis() const { return glm::dvec3(0.0, 0.0, 1.0); }

  /**
   * Convex polygons that together emit what the light does, each of at most MaximumVertices: their
   * closed form is for the graphics processor. None for lights of other kinds.
   */
  virtual std::vector<EmittingPolygon> GetPolygons() const { return {}; }
  static constexpr std::size_t MaximumVertices = 8;

  /// Numbers that tell lights apart, to order them by.
  virtual std::vector<double> GetKey() const = 0;

protected:
  LightShape() = default;
  LightShape(const LightShape&) = default;
  LightShape& operator=(const LightShape&) = default;

  /// The part of the key that all kinds share.
  std::vector<double> MakeKey(int kind) const
  {
    return { this->Radiance.x, this->Radiance.y, this->Radiance.z, this->TwoSided ? 1.0 : 0.0,
      static_cast<double>(kind) };
  }
};

/**
 * The part of LightShape that is the same for every `Kind`, which has Transformed() and
 * ClippedToFront() with values of its own kind.
 */
template <typename Kind>
class LightOfKind : public LightShape
{
public:
  std::unique_ptr<LightShape> Clone() const override
  {
    return std::make_unique<Kind>(static_cast<const Kind&>(*this));
  }
  std::unique_ptr<LightShape> Transform(const glm::dmat4& matrix) const override
  {
    return std::make_unique<Kind>(static_cast<const Kind&>(*this).Transformed(matrix));
  }
  std::unique_ptr<LightShape> Clip(const glm::dvec3& point, const glm::dvec3& normal) const override
  {
    return std::make_unique<Kind>(static_cast<const Kind&>(*this).ClippedToFront(point, normal));
  }
};

/// A light of any kind, as a value.
class PENUMBRARENDERING_EXPORT Light
{
public:
  template <typename Kind>
  Light(const LightOfKind<Kind>& light)
    : Shape(light.Clone())
  {
  }
  explicit Light(std::unique_ptr<LightShape> shape)
    : Shape(std::move(shape))
  {
  }
  Light(const Light& other)
    : Shape(other.Shape->Clone())
  {
  }
  Light(Light&&) = default;
  Light& operator=(Light other)
  {
    std::swap(this->Shape, other.Shape);
    return *this;
  }

  LightShape* operator->() { return this->Shape.get(); }
  const LightShape* operator->() const { return this->Shape.get(); }
  LightShape& operator*() { return *this->Shape; }
  const LightShape& operator*() const { return *this->Shape; }

private:
  std::unique_ptr<LightShape> Shape;
};

} // namespace penumbra

#endif
