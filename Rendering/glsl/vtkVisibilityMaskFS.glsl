//VTK::System::Dec

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// The logic op of the framebuffer ORs the bits of all fragments of a texel.

flat in uint sampleBit;
out uint mask;

void main()
{
  mask = sampleBit;
}
