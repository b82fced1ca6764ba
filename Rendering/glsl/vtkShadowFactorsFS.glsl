//VTK::System::Dec
//VTK::Output::Dec

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// The factor of the diffuse shade, over `scale`: the radiance relative to what it would be unblocked, in the mean of
// the components; the hue of the light stays. Where no light could arrive, there is no shadow.

uniform sampler2D radiance; // vtkRadianceTexture's irradiance
uniform vec3 ambient;
uniform float scale;

void main()
{
  vec4 arriving = texelFetch(radiance, ivec2(gl_FragCoord.xy), 0);
  vec3 shown = arriving.rgb + ambient;
  float unblocked = arriving.a + dot(shown, vec3(1.0 / 3.0));
  gl_FragData[0] = vec4((unblocked > 0.0 ? shown / unblocked : vec3(1.0)) / scale, 1.0);
}
