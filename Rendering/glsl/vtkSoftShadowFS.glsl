// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Put into the fragment shader of every actor that receives shadows, by vtkSoftShadowPass.
//
// A receiver is planar, so where a fragment lies on it is an affine map of where it lies in the view. VTK's shaders
// of lit actors know that as vertexVC. PENUMBRA_POSITION is then (vertexVC, 1), PENUMBRA_VIEW is defined, and so is
// PENUMBRA_VARYING if the vertex shader itself can hand on (u, v), which is cheapest. Otherwise the position is
// gl_FragCoord, from which the map is projective: it depends on no other shader.
//
// Where a plane stands for a surface (PENUMBRA_PROXY is defined then, if positions are of the view), the map also
// projects the fragment onto that plane, from the lights' centre (H&H 1997, figure 5).

uniform sampler2D penumbraTexture; // for shadows, vtkShadowFactors; for radiance, the irradiance over pi
uniform float penumbraScale;       // of the factors
#ifdef PENUMBRA_VIEW
#define PENUMBRA_MAPS penumbraViewMaps
#else
#define PENUMBRA_MAPS penumbraScreenMaps
#endif
uniform mat4 PENUMBRA_MAPS[PENUMBRA_RECEIVERS];  // (position, 1) to (u q, v q, h q, q), with h = 0 on the plane
uniform vec4 penumbraPlaces[PENUMBRA_RECEIVERS]; // (u, v) to texture coordinates: origin, size
uniform vec4 penumbraAmbient[PENUMBRA_RECEIVERS]; // a: what u + v may be at most: 1 for half of a slot
uniform vec3 penumbraReflectance[PENUMBRA_RECEIVERS];
#ifdef PENUMBRA_VARYING
in vec2 penumbraUVVSOutput;
#endif

vec4 penumbraTransform(mat4 map, vec4 position)
{
#if defined(PENUMBRA_VIEW) && !defined(PENUMBRA_PROXY)
  return vec4(mat4x3(map) * position, 1.0); // q = 1: the compiler drops the divisions
#else
  return map * position;
#endif
}

// The texel at the fragment, and its receiver's settings: what is not used costs nothing.
vec3 penumbraLookUp(vec4 position, out vec3 ambient, out vec3 reflectance)
{
  ambient = penumbraAmbient[0].rgb;
  reflectance = penumbraReflectance[0];
#if defined(PENUMBRA_VARYING)
  return texture(penumbraTexture, penumbraUVVSOutput).rgb; // one receiver fills its texture, which clamps to its edge
#elif PENUMBRA_RECEIVERS == 1
  vec4 uvhq = penumbraTransform(PENUMBRA_MAPS[0], position);
  return texture(penumbraTexture, uvhq.xy / uvhq.w).rgb;
#else
  // Of several receivers, the one that is closest to the fragment. What belongs to it is kept on the way: an array
  // with an index that differs between fragments is slow to read. The height weighs more than what lies beside the
  // receiver, so that all pixels of a quad that a triangle's edge crosses find the same one: their differences give
  // the mip level. Where they do not, the gutters of the atlas keep the receivers apart.
  vec2 uv = vec2(0.0);
  vec4 place = penumbraPlaces[0];
  float limit = penumbraAmbient[0].a;
  float nearest = 3.0e38;
  for (int i = 0; i < PENUMBRA_RECEIVERS; ++i)
  {
#if PENUMBRA_WINDOWS > 0
    // The first are windows of finer texels in the others: where a fragment lies in both, they come before these,
    // for all that rounding does to heights.
    nearest -= i == PENUMBRA_WINDOWS ? 1.0e-3 : 0.0;
#endif
    vec4 uvhq = penumbraTransform(PENUMBRA_MAPS[i], position);
    vec3 uvh = uvhq.xyz / uvhq.w;
    vec2 outside = abs(uvh.xy - 0.5);
    float beyond = max(max(outside.x, outside.y), uvh.x + uvh.y - penumbraAmbient[i].a + 0.5);
    float distance = max(beyond, 0.5) + 4.0 * abs(uvh.z);
    if (distance < nearest)
    {
      nearest = distance;
      uv = uvh.xy;
      place = penumbraPlaces[i];
      limit = penumbraAmbient[i].a;
      ambient = penumbraAmbient[i].rgb;
      reflectance = penumbraReflectance[i];
    }
  }
  uv = clamp(uv, 0.0, 1.0);
  uv -= 0.5 * max(uv.x + uv.y - limit, 0.0); // it stays within [0, 1]^2
  return texture(penumbraTexture, place.xy + uv * place.zw).rgb;
#endif
}

// The factor of the diffuse shade.
vec3 penumbraShadow(vec4 position)
{
  vec3 ambient, reflectance;
  return penumbraScale * penumbraLookUp(position, ambient, reflectance);
}

// H&H 1997, eq. 1.
vec3 penumbraRadiance(vec4 position)
{
  vec3 ambient, reflectance;
  vec3 arriving = penumbraLookUp(position, ambient, reflectance);
  return reflectance * (ambient + arriving);
}
