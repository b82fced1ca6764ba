//VTK::System::Dec
//VTK::Output::Dec

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Adds what an unoccluded polygon sends to each texel of a rectangle: irradiance / pi.

//Penumbra::FormFactor::Dec
//Penumbra::Texel::Dec

uniform vec3 lightRadiance;

void main()
{
  vec3 x = texelPlace(ivec2(gl_FragCoord.xy) + firstTexel);
  float side = lightSide(x);
  float form = side > 0.0 || (side < 0.0 && lightTwoSided != 0) ? formFactor(x) : 0.0;
  gl_FragData[0] = vec4(lightRadiance * form, 0.0);
}
