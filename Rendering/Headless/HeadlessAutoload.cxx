// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// What VTK looks for in each library of a folder that VTK_AUTOLOAD_PATH names: two C functions that
// give a factory, which VTK then registers.

#include "vtkHeadlessFactory.h"
#include "vtkVersion.h"

VTK_FACTORY_INTERFACE_IMPLEMENT(vtkHeadlessFactory)
