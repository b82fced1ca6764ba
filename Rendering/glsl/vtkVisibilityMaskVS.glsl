//VTK::System::Dec

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// One instance of the occluders for each light sample of the batch, registered on the receiver
// (H&H 1997, 3.3; penumbra::RegisteredProjection).

in vec4 vertexUVHT; // and a height that all of the vertex's surface is below

uniform vec3 registration[32]; // xy: k.x and k.y of each sample; z: its height, 0 for a direction
uniform int firstBit; // of the layer: the first instance's
uniform vec2 receiverTexels;

flat out uint sampleBit;
out float gl_ClipDistance[2];

// w' = 1 - k.z h as a difference of heights, which is exact, with its sign, for what is about as high as the
// sample.
float homogeneous(float h, float sampleHeight)
{
  return sampleHeight > 0.0 ? (sampleHeight - h) / sampleHeight : 1.0;
}

void main()
{
  const float smallestW = 1.0 / 1024.0;
  int bit = firstBit + gl_InstanceID;
  vec3 to = registration[bit];
  float w = homogeneous(vertexUVHT.z, to.z);
  vec2 p = vertexUVHT.xy - to.xy * vertexUVHT.z;
  // Rasterisers put vertices on a grid of 1/256 of a texel. They are put there already, so that nothing that
  // a viewport adds rounds them to another place of that grid: a texel's bits are the same in any rectangle.
  // Not where the surface reaches the sample: an edge that goes past it bears no moving of its ends. Nor
  // what is far away: divisions would round it by more than a receiver near by can bear.
  vec2 place = p / max(w, smallestW);
  vec2 texel = place * receiverTexels;
  if (homogeneous(vertexUVHT.w, to.z) > smallestW && max(abs(place.x), abs(place.y)) < 16.0 &&
    max(abs(texel.x), abs(texel.y)) < 16384.0)
  {
    p = floor(texel * 256.0 + 0.5) / (256.0 * receiverTexels) * w;
  }
  gl_Position = vec4(2.0 * p - w, 0.0, w); // [0, 1] w' is [-w, w]
  gl_ClipDistance[0] = vertexUVHT.z;
  gl_ClipDistance[1] = w;
  sampleBit = 1u << uint(bit);
}
