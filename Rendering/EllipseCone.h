// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What ellipses send to a point.
 */
#ifndef EllipseCone_h
#define EllipseCone_h

#include "PenumbraRenderingModule.h" // for the export macro

#include "Vectors.h"

namespace penumbra
{

/**
 * The cone of the directions from a point to an ellipse, and the form factor of the ellipse.
 *
 * Vectors are along the ellipse's two axes and its normal away from the point. With the semi-axes a
 * and b and the centre d, the planes that touch the cone have the normals n with
 * (a n.x)^2 + (b n.y)^2 = (n . d)^2, so the eigenvectors of diag(a^2, b^2, 0) - d d^T are the
 * cone's axes. The one eigenvalue below 0 is -nu, where nu is the largest root of d.x^2 / (a^2 +
 * nu) + d.y^2 / (b^2 + nu) + d.z^2 / nu = 1: the ellipsoid through the point whose focal ellipse
 * has these semi-axes has the cone's axis for its normal.
 */
class PENUMBRARENDERING_EXPORT EllipseCone
{
public:
  /// The centre is seen from the point, its z above 0; both semi-axes are above 0, in any order.
  EllipseCone(const glm::dvec3& centre, double a, double b);

  /**
   * The form factor of the whole ellipse, which lies above the horizon of the unit normal.
   *
   * In the axes of the cone the ellipse has the outline (alpha cos t, beta sin t, 1); Lambert's
   * contour integral over it has no part but along the cone's axis, alpha beta / sqrt((1 + alpha^2)
   * (1 + beta^2)). Written with nu, it is a product and sums of what has one sign, so that nothing
   * is lost where the ellipse is small, far, near or thin.
   */
  double GetFormFactor(const glm::dvec3& normal) const;

  /**
   * The form factor of the part of the ellipse above the horizon of the unit normal: Lambert's
   * contour integral over the arc that is left and over its chord, as of a disk (DiskLight). The
   * arc's is in elementary functions, too. The error is some roundings of 1.
   */
  double GetFormFactorAboveHorizon(const glm::dvec3& normal) const;

private:
  /// The cone in its own axes: (alpha cos t, beta sin t, 1), alpha >= beta.
  struct Outline
  {
    glm::dmat3 Axes; ///< right-handed
    double Alpha, Beta;
  };
  Outline FindOutline() const;

  // Over the largest length of all.
  glm::dvec3 Centre;
  glm::dvec2 SemiAxes;
  double Nu;
  glm::dvec3 Axis; ///< along the cone's axis, not a unit vector
};

} // namespace penumbra

#endif
