// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// The form factor of an unoccluded convex polygon, as penumbra::PolygonLight::FormFactor() computes it,
// but arranged for single precision. All positions are in the receiver's metric frame: the receiver is
// the plane z = 0, and the polygon, which has been clipped to it, lies at z >= 0.

//Penumbra::LightIsLow::Dec

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

// The angle, in (-pi, pi], of a direction in the plane.
float arcOf(float sine, float cosine)
{
  float s = abs(sine);
  float angle = cosine > 0.0 ? arcTangent(s / cosine)
    : cosine < 0.0           ? 3.141592654 - arcTangent(-s / cosine)
    : s > 0.0                ? 1.570796327
                             : 0.0;
  return sine < 0.0 ? -angle : angle;
}

// How far x is in front of the light's plane.
float lightSide(vec3 x)
{
  return dot(lightNormal, x - lightVertices[0]);
}

#if LIGHT_IS_LOW == 0

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

#else

// angle of an arc, up to pi, times the cosine of its plane to the horizon, minus its part of the azimuth:
// what the arc and its shadow on the horizon enclose. Both are nearly equal for what is low, and neither
// way below takes the difference of numbers that are.
//   normal: the cross product of the ends; cosine, level: their dot product, and that of their horizontal
//   parts; heights: the product of the vertical parts; all for ends of length 1
//   shrink: how long the horizontal parts are, multiplied; loss: 1 - shrink
float areaBelowArc(vec3 normal, float cosine, float level, float heights, float shrink, float loss)
{
  float sine = length(normal);
  float turned = abs(normal.z);
  float leaning2 = dot(normal.xy, normal.xy);
  float scale = max(sine + turned, 1e-30);
  bool isShort = cosine > 0.0 && sine * sine < 0.04 && shrink > 0.5;
  if (isShort && turned * sine * sine * scale < 6.0 * leaning2)
  {
    // Angle and azimuth by their excess over their sines.
    float excess = arcExcess(sine, cosine);
    return turned / shrink * (excess - arcExcess(turned / shrink, level / shrink) - loss * (1.0 + excess));
  }
  // The angle minus the azimuth by the tangent of the difference.
  float difference = arcOf(level * leaning2 / scale - turned * heights, cosine * level + sine * turned);
  return difference - arcOf(sine, cosine) * leaning2 / max(sine * scale, 1e-30);
}

// The first arrangement above loses its digits where the light is low for its size: the light then looks
// like a strip along the horizon, whose area is the difference of sums along its upper and its lower side.
// Here, what each edge's arc encloses with the horizon below it is added up:
//   2 pi F = sum of (angle_i (u_i x u_{i+1}).z / |u_i x u_{i+1}| - azimuth_i) + 2 pi turns,
// with 1 turn where the light goes once around the zenith.
float formFactor(vec3 x)
{
  float sum = 0.0;
  float azimuth = 0.0;
  for (int i = 0; i < lightVertexCount; ++i)
  {
    int j = i + 1 < lightVertexCount ? i + 1 : 0;
    vec3 p = lightVertices[i] - x;
    vec3 q = lightVertices[j] - x;
    float inverseP = 1.0 / max(length(p), 1e-30);
    float inverseQ = 1.0 / max(length(q), 1e-30);
    vec3 normal = cross(p * inverseP, lightEdges[i] * inverseQ);
    p *= inverseP;
    q *= inverseQ;
    float level = dot(p.xy, q.xy);
    float shrink = length(p.xy) * length(q.xy);
    float loss = (p.z * p.z + q.z * q.z - p.z * p.z * q.z * q.z) / (1.0 + shrink);
    float area = areaBelowArc(normal, dot(p, q), level, p.z * q.z, shrink, loss);
    float side = normal.z < 0.0 ? -1.0 : 1.0;
    sum += side * area;
    azimuth += side * arcOf(abs(normal.z), level);
  }
  float turns = floor(azimuth * 0.1591549431 + 0.5);
  return clamp(abs(sum * 0.1591549431 + turns), 0.0, 1.0);
}

#endif
