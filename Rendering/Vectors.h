// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * GLM's vectors and matrices. VTK's wrapping tools, which read headers to make Python modules of
 * them, take more than ten minutes over GLM's (then they were stopped): they do without.
 */
#ifndef Vectors_h
#define Vectors_h

#ifndef __VTK_WRAP__
#include <glm/glm.hpp>
#endif

#endif
