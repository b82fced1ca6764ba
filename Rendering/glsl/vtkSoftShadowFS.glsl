// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Put into the fragment shader of every actor that receives shadows, by vtkSoftShadowPass.
//
// A receiver is planar, so where a fragment lies on it is a projective map of where it lies on the screen:
// no varying is needed, and nothing depends on which shaders VTK puts before this one.

uniform sampler2D penumbraTexture;
uniform vec3 penumbraRows[3 * PENUMBRA_RECEIVERS];   // (gl_FragCoord.xy, 1) to (u q, v q, q)
uniform vec3 penumbraDepths[PENUMBRA_RECEIVERS];     // (gl_FragCoord.xy, 1) to the plane's gl_FragCoord.z
uniform vec4 penumbraPlaces[PENUMBRA_RECEIVERS];     // (u, v) to texture coordinates: origin, size
uniform vec3 penumbraAmbient[PENUMBRA_RECEIVERS];
uniform vec3 penumbraReflectance[PENUMBRA_RECEIVERS];

// Of several receivers, the one whose plane passes closest to the fragment.
int penumbraFindReceiver(vec3 pixel)
{
  int nearest = 0;
#if PENUMBRA_RECEIVERS > 1
  float nearestDistance = 2.0;
  for (int i = 0; i < PENUMBRA_RECEIVERS; ++i)
  {
    vec2 uv = vec2(dot(penumbraRows[3 * i], pixel), dot(penumbraRows[3 * i + 1], pixel)) /
      dot(penumbraRows[3 * i + 2], pixel);
    vec2 outside = max(abs(uv - 0.5) - 0.5, 0.0);
    // What is outside a receiver's parallelogram by a texel or more belongs to another one.
    float distance = abs(dot(penumbraDepths[i], pixel) - gl_FragCoord.z) +
      (max(outside.x, outside.y) > 0.01 ? 1.0 : 0.0);
    if (distance < nearestDistance)
    {
      nearestDistance = distance;
      nearest = i;
    }
  }
#endif
  return nearest;
}

// The irradiance over pi at the fragment, and in a what is blocked, in the mean of the components.
vec4 penumbraLookUp(int i, vec3 pixel)
{
  vec3 rowU = penumbraRows[3 * i];
  vec3 rowV = penumbraRows[3 * i + 1];
  vec3 rowQ = penumbraRows[3 * i + 2];
  float inverse = 1.0 / dot(rowQ, pixel);
  vec2 uv = vec2(dot(rowU, pixel), dot(rowV, pixel)) * inverse;
#if PENUMBRA_RECEIVERS == 1
  return texture(penumbraTexture, uv); // the receiver fills its texture, which clamps to its edge
#else
  // The derivatives of (u q) / q: those that OpenGL would take fail where one receiver meets the next.
  vec2 dx = (vec2(rowU.x, rowV.x) - uv * rowQ.x) * inverse;
  vec2 dy = (vec2(rowU.y, rowV.y) - uv * rowQ.y) * inverse;
  vec4 place = penumbraPlaces[i];
  return textureGrad(
    penumbraTexture, place.xy + clamp(uv, 0.0, 1.0) * place.zw, dx * place.zw, dy * place.zw);
#endif
}

// The factor of the diffuse shade: the radiance relative to what it would be unblocked, in the mean of the
// components; the hue of the light stays. Where no light could arrive, there is no shadow.
vec3 penumbraShadow()
{
  vec3 pixel = vec3(gl_FragCoord.xy, 1.0);
  int i = penumbraFindReceiver(pixel);
  vec4 arriving = penumbraLookUp(i, pixel);
  float unblocked = arriving.a + dot(arriving.rgb + penumbraAmbient[i], vec3(1.0 / 3.0));
  return unblocked > 0.0 ? (arriving.rgb + penumbraAmbient[i]) / unblocked : vec3(1.0);
}

// H&H 1997, eq. 1.
vec3 penumbraRadiance()
{
  vec3 pixel = vec3(gl_FragCoord.xy, 1.0);
  int i = penumbraFindReceiver(pixel);
  return penumbraReflectance[i] * (penumbraAmbient[i] + penumbraLookUp(i, pixel).rgb);
}
