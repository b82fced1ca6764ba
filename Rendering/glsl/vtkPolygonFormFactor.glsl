// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// The form factor of an unoccluded convex polygon, as penumbra::PolygonLight::FormFactor() computes it,
// but arranged for single precision. All positions are in the receiver's metric frame: the receiver is
// the plane z = 0, and the polygon, which has been clipped to it, lies at z >= 0.

const int MaximumLightVertices = 8;
uniform int lightVertexCount;
uniform vec3 lightVertices[MaximumLightVertices];
uniform vec3 lightEdges[MaximumLightVertices];  // to the next vertex, exact to single precision
uniform vec3 lightSpokes[MaximumLightVertices]; // from the first vertex, likewise
uniform vec3 lightNormal;
uniform int lightTwoSided;

// atan(x) for x >= 0 to 2e-7: the argument is brought below tan(pi/8), then the polynomial of Cephes'
// atanf. The built-in function is only as good as the driver likes.
float arcTangent(float x)
{
  float base = 0.0;
  if (x > 2.414213562)
  {
    base = 1.570796327;
    x = -1.0 / x;
  }
  else if (x > 0.4142135624)
  {
    base = 0.7853981634;
    x = (x - 1.0) / (x + 1.0);
  }
  float z = x * x;
  return base + x +
    x * z * (((8.05374449538e-2 * z - 1.38776856032e-1) * z + 1.99777106478e-1) * z - 3.33329491539e-1);
}

// angle / sin(angle) - 1, for an angle in [0, pi] given by its sine and cosine.
float arcExcess(float sine, float cosine)
{
  float s2 = sine * sine;
  if (cosine > 0.0 && s2 < 0.04)
  {
    // The series of asin(s) / s - 1; the first term left out is below 1e-9.
    return s2 * (1.0 / 6.0 +
      s2 * (3.0 / 40.0 + s2 * (15.0 / 336.0 + s2 * (105.0 / 3456.0 + s2 * (945.0 / 42240.0)))));
  }
  float s = max(sine, 1e-12);
  float angle = cosine > 0.0 ? arcTangent(s / cosine)
    : cosine < 0.0           ? 3.141592654 - arcTangent(-s / cosine)
                             : 1.570796327;
  return angle / s - 1.0;
}

// How far x is in front of the light's plane.
float lightSide(vec3 x)
{
  return dot(lightNormal, x - lightVertices[0]);
}

// Lambert's formula, F = 1/(2 pi) sum of angle_i (v_i x v_{i+1}).z / |v_i x v_{i+1}|, loses all its digits
// to cancellation when the light is small or far. It is split here, with unit vectors u_i and
// |u_i x u_{i+1}| = sin(angle_i), into the polygon of the u_i projected onto the receiver (Nusselt) and what
// the arcs add to its chords:
//   2 pi F = sum of (u_i x u_{i+1}).z  +  sum of (angle_i / sin(angle_i) - 1) (u_i x u_{i+1}).z
// The first sum is a fan of triangles around u_0 with sides u_i - u_0 that are computed from the spokes,
// not by subtraction; the second is of third order in the light's size.
float formFactor(vec3 x)
{
  vec3 p0 = lightVertices[0] - x;
  float r0 = length(p0);
  vec2 previousSide = vec2(0.0);
  float chords = 0.0;
  float arcs = 0.0;
  for (int i = 0; i < lightVertexCount; ++i)
  {
    int j = i + 1 < lightVertexCount ? i + 1 : 0;
    vec3 p = lightVertices[i] - x;
    vec3 q = lightVertices[j] - x;
    float r = length(p);
    float inverse = 1.0 / max(r * length(q), 1e-30);

    vec3 normal = cross(p, lightEdges[i]) * inverse;
    arcs += arcExcess(length(normal), dot(p, q) * inverse) * normal.z;

    float difference = -dot(lightSpokes[i], p0 + p); // r0^2 - r^2
    vec2 side = (lightSpokes[i].xy + p0.xy * (difference / max(r0 * (r0 + r), 1e-30))) / max(r, 1e-30);
    chords += previousSide.x * side.y - previousSide.y * side.x;
    previousSide = side;
  }
  return clamp(abs(chords + arcs) * 0.1591549431, 0.0, 1.0);
}
