//VTK::System::Dec

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// One instance of the occluders for each light sample of the batch, registered on the receiver
// (H&H 1997, 3.3; penumbra::RegisteredProjection).

in vec3 vertexUVH;

uniform vec4 registration[32]; // xy: k.x and k.y of each sample; z: its height, 0 for a direction; w: 1 if all
                               // occluders are below it
uniform vec2 receiverTexels;

flat out uint sampleBit;
out float gl_ClipDistance[2];

void main()
{
  // w' = 1 - k.z h as a difference of heights, which is exact, with its sign, for what is about as high
  // as the sample.
  vec4 to = registration[gl_InstanceID];
  float w = to.z > 0.0 ? (to.z - vertexUVH.z) / to.z : 1.0;
  vec2 p = vertexUVH.xy - to.xy * vertexUVH.z;
  // Rasterisers put vertices on a grid of 1/256 of a texel. They are put there already, so that nothing that
  // a viewport adds rounds them to another place of that grid: a texel's bits are the same in any rectangle.
  // What is far away stays as it is: divisions would round it by more than a receiver near by can bear.
  vec2 place = p / max(w, 1.0 / 1024.0);
  vec2 texel = place * receiverTexels;
  if (to.w > 0.0 && max(abs(place.x), abs(place.y)) < 16.0 && max(abs(texel.x), abs(texel.y)) < 16384.0)
  {
    p = floor(texel * 256.0 + 0.5) / (256.0 * receiverTexels) * w;
  }
  gl_Position = vec4(2.0 * p - w, 0.0, w); // [0, 1] w' is [-w, w]
  gl_ClipDistance[0] = vertexUVH.z;
  gl_ClipDistance[1] = w;
  sampleBit = 1u << uint(gl_InstanceID);
}
