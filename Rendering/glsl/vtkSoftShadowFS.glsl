// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Put into the fragment shader of every actor that receives shadows, by vtkSoftShadowPass.
//
// A receiver is planar, so where a fragment lies on it is an affine map of where it lies in the view. VTK's shaders
// of lit actors know that as vertexVC. PENUMBRA_POSITION is then (vertexVC, 1), PENUMBRA_VIEW is defined, and so is
// PENUMBRA_VARYING if the vertex shader itself can hand on (u, v), which is cheapest. Otherwise the position is
// gl_FragCoord, from which the map is projective: it depends on no other shader.
//
// PENUMBRA_SEVERAL: the actor has several receivers, and a table says which of them are near a fragment.
//
// Where a plane stands for a surface (PENUMBRA_PROXY is defined then), the fragment is also projected onto that plane,
// from the lights' centre (H&H 1997, figure 5).

uniform sampler2D penumbraTexture; // for shadows, vtkShadowFactors; for radiance, the irradiance over pi
uniform float penumbraScale;       // of the factors

// What is shown at a fragment, and its receiver's settings.
struct PenumbraTexel
{
  vec3 value; // of the texture
  vec3 ambient;
  vec3 reflectance;
  float middleLight; // vtkReceiverTable's MiddleLight
  bool isSeen;       // from the side that the texture is for: from the other one, the ambient alone arrives
};

#ifdef PENUMBRA_SEVERAL

uniform samplerBuffer penumbraRecords; // vtkReceiverTable, which says what is in it
uniform usamplerBuffer penumbraGrid;   // penumbra::ReceiverGrid, too
uniform vec3 penumbraGridScale;        // from the table's frame to the grid's box
uniform vec3 penumbraGridOffset;
uniform vec3 penumbraGridCells;        // of the outermost grid
uniform mat3 penumbraFromView;         // directions of the view, in the table's frame
uniform vec3 penumbraEye;              // where the view's origin is in its frame
uniform vec3 penumbraEyeRest;          // what single precision leaves of that
uniform vec4 penumbraSight;            // where the camera looks, in the table's frame; w: 1 if rays are parallel
#ifndef PENUMBRA_VIEW
uniform mat4 penumbraToView;           // gl_FragCoord to the view, homogeneous
#endif

const uint PenumbraList = 0x40000000u; // words of penumbra::ReceiverGrid
const uint PenumbraReceiver = 0x80000000u;
const uint PenumbraMoreFollow = 0x40000000u;

// Where in the grid the first receiver is named that is near a place of the table's frame, and its word. There is one
// loop, and one in penumbraLookUp(): software OpenGL runs through each at least once for every fragment.
int penumbraFindCell(vec3 place, out uint word)
{
  vec3 cells = penumbraGridCells;
  vec3 inGrid = clamp(place * penumbraGridScale + penumbraGridOffset, 0.0, 1.0);
  int at = 0;
  word = 0u;
  do
  {
    inGrid *= cells;
    vec3 cell = min(floor(inGrid), cells - 1.0);
    at = word < PenumbraList ? int(word) + int(cell.x + cells.x * (cell.y + cells.y * cell.z))
                             : int(word - PenumbraList);
    word = texelFetch(penumbraGrid, at).r;
    inGrid -= cell;
    cells = vec3(4.0);
  } while (word < PenumbraReceiver);
  return at;
}

// A receiver of the table, and where a fragment is in its frame.
struct PenumbraPlace
{
  vec3 toU, toV; // from places of the table's frame
  vec3 uvh;
  float limit;   // what u + v may be at most: 1 for half of a slot
  float distance;
  bool isSeen;   // from the side that its texels are for
};

// Larger than distances are: of a receiver whose other side has texels of its own.
const float PenumbraHidden = 1.0e30;

PenumbraPlace penumbraReadReceiver(int first, vec3 fromEye)
{
  vec4 u = texelFetch(penumbraRecords, first);
  vec4 v = texelFetch(penumbraRecords, first + 1);
  vec4 h = texelFetch(penumbraRecords, first + 2);
  vec4 rest = texelFetch(penumbraRecords, first + 3);
  // The eye relative to the receiver's corner comes first: where they are near each other, nothing is lost.
  vec3 eye = (penumbraEye - vec3(u.w, v.w, h.w)) + penumbraEyeRest;
  vec3 place = fromEye + eye;
  PenumbraPlace receiver;
  receiver.toU = u.xyz;
  receiver.toV = v.xyz;
  receiver.uvh = vec3(dot(u.xyz, place), dot(v.xyz, place), dot(h.xyz, place)) + rest.xyz;
  receiver.limit = abs(rest.w);
#ifdef PENUMBRA_PROXY
  vec4 projection = texelFetch(penumbraRecords, first + 7);
  bool isProxy = projection.w > 0.0;
#else
  const bool isProxy = false;
#endif
#ifndef PENUMBRA_VIEW
  // Depth has few digits, so the ray decides where the fragment is on the plane.
  vec3 sight = penumbraSight.w > 0.0 ? penumbraSight.xyz : fromEye;
  float falls = dot(h.xyz, sight);
  if (!isProxy && falls != 0.0)
  {
    receiver.uvh.xy -= receiver.uvh.z / falls * vec2(dot(u.xyz, sight), dot(v.xyz, sight));
  }
#endif
#ifdef PENUMBRA_PROXY
  if (isProxy)
  {
    receiver.uvh.xy = (receiver.uvh.xy - projection.xy * receiver.uvh.z) / (1.0 - projection.z * receiver.uvh.z);
    receiver.uvh.z = PENUMBRA_PROXY;
  }
#endif
  // The height weighs more than what lies beside the receiver. Windows of finer texels come before the receivers that
  // they lie in, for all that rounding does to heights.
  vec2 outside = abs(receiver.uvh.xy - 0.5);
  float beyond = max(max(outside.x, outside.y), receiver.uvh.x + receiver.uvh.y - receiver.limit + 0.5);
  receiver.distance = max(beyond, 0.5) + 4.0 * abs(receiver.uvh.z) - (rest.w < 0.0 ? 1.0e-3 : 0.0);
  // Where the eye is decides, not the fragment's normal: data may have it either way.
  float height = penumbraSight.w > 0.0 ? -dot(h.xyz, penumbraSight.xyz) : dot(h.xyz, eye) + rest.z;
  float side = texelFetch(penumbraRecords, first + 5).w;
  receiver.isSeen = side * height >= 0.0;
  receiver.distance += abs(side) > 1.5 && !receiver.isSeen ? PenumbraHidden : 0.0;
  return receiver;
}

// The texel at the fragment, and its receiver's settings: what is not used costs nothing.
PenumbraTexel penumbraLookUp(vec4 position)
{
#ifdef PENUMBRA_VIEW
  vec3 inView = position.xyz;
#else
  vec4 homogeneous = penumbraToView * position;
  vec3 inView = homogeneous.xyz / homogeneous.w;
#endif
  vec3 fromEye = penumbraFromView * inView;
  uint word;
  int at = penumbraFindCell(fromEye + penumbraEye, word);
  int first = 0;
  PenumbraPlace nearest;
  nearest.distance = 3.0e38;
  for (;;)
  {
    int record = PENUMBRA_RECORD * int(word & (PenumbraMoreFollow - 1u));
    PenumbraPlace receiver = penumbraReadReceiver(record, fromEye);
    if (receiver.distance < nearest.distance)
    {
      nearest = receiver;
      first = record;
    }
    if (word < PenumbraReceiver + PenumbraMoreFollow)
    {
      break;
    }
    word = texelFetch(penumbraGrid, ++at).r;
  }
  PenumbraTexel texel;
  texel.ambient = texelFetch(penumbraRecords, first + 5).rgb;
  vec4 reflectance = texelFetch(penumbraRecords, first + 6);
  texel.reflectance = reflectance.rgb;
  texel.middleLight = reflectance.a;
  texel.isSeen = nearest.isSeen;
  vec4 place = texelFetch(penumbraRecords, first + 4);
  vec2 uv = clamp(nearest.uvh.xy, 0.0, 1.0);
  uv -= 0.5 * max(uv.x + uv.y - nearest.limit, 0.0); // it stays within [0, 1]^2
  // How (u, v) changes from pixel to pixel is asked of the receiver of this pixel: its neighbours may have found others.
  vec3 right = penumbraFromView * dFdx(inView);
  vec3 up = penumbraFromView * dFdy(inView);
  texel.value = textureGrad(penumbraTexture, place.xy + uv * place.zw,
    place.zw * vec2(dot(nearest.toU, right), dot(nearest.toV, right)),
    place.zw * vec2(dot(nearest.toU, up), dot(nearest.toV, up))).rgb;
  return texel;
}

#else

#ifdef PENUMBRA_VIEW
#define PENUMBRA_MAP penumbraViewMap
#else
#define PENUMBRA_MAP penumbraScreenMap
#endif
uniform mat4 PENUMBRA_MAP; // (position, 1) to (u q, v q, h q, q), with h = 0 on the plane
uniform vec3 penumbraAmbient;
uniform vec3 penumbraReflectance;
uniform float penumbraMiddleLight;
uniform bool penumbraIsSeen; // from the side that its texels are for
#ifdef PENUMBRA_VARYING
in vec2 penumbraUVVSOutput;
#endif

// The texel at the fragment, and its receiver's settings. The only receiver fills its texture, which clamps to its edge.
PenumbraTexel penumbraLookUp(vec4 position)
{
#if defined(PENUMBRA_VARYING)
  vec2 uv = penumbraUVVSOutput;
#elif defined(PENUMBRA_VIEW) && !defined(PENUMBRA_PROXY)
  vec2 uv = (PENUMBRA_MAP * position).xy; // q = 1
#else
  vec4 uvhq = PENUMBRA_MAP * position;
  vec2 uv = uvhq.xy / uvhq.w;
#endif
  return PenumbraTexel(texture(penumbraTexture, uv).rgb, penumbraAmbient, penumbraReflectance, penumbraMiddleLight,
    penumbraIsSeen);
}

#endif

// The factor of the diffuse shade. Seen from the other side, all of the light that the receiver's middle would get is
// blocked, as vtkShadowFactorsFS.glsl has it.
vec3 penumbraShadow(vec4 position)
{
  PenumbraTexel texel = penumbraLookUp(position);
  if (texel.isSeen)
  {
    return penumbraScale * texel.value;
  }
  float unblocked = texel.middleLight + dot(texel.ambient, vec3(1.0 / 3.0));
  return unblocked > 0.0 ? texel.ambient / unblocked : vec3(1.0);
}

// H&H 1997, eq. 1.
vec3 penumbraRadiance(vec4 position)
{
  PenumbraTexel texel = penumbraLookUp(position);
  return texel.reflectance * (texel.ambient + (texel.isSeen ? texel.value : vec3(0.0)));
}
