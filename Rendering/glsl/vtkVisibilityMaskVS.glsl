//VTK::System::Dec

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// One instance of the occluders for each light sample of the batch, registered on the receiver
// (H&H 1997, 3.3; penumbra::RegisteredProjection).

in vec3 vertexUVH;

uniform vec4 registration[32];  // xyz: k of each sample
uniform vec4 windowTransform;   // (x', y') to clip coordinates: xy scales, zw times w' is added
uniform float contactTolerance; // what is lower lies in the receiver

flat out uint sampleBit;
out float gl_ClipDistance[2];

void main()
{
  vec3 k = registration[gl_InstanceID].xyz;
  float w = 1.0 - k.z * vertexUVH.z;
  vec2 p = vertexUVH.xy - k.xy * vertexUVH.z;
  gl_Position = vec4(p * windowTransform.xy + w * windowTransform.zw, 0.0, w);
  gl_ClipDistance[0] = vertexUVH.z - contactTolerance;
  gl_ClipDistance[1] = w;
  sampleBit = 1u << uint(gl_InstanceID);
}
