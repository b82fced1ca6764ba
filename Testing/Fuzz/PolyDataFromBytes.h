// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Polygonal data as nobody should make them, of a fuzzer's bytes.
 */
#ifndef PolyDataFromBytes_h
#define PolyDataFromBytes_h

#include "ByteReader.h"

#include <vtkSmartPointer.h>

class vtkPolyData;

/// Of the cell array that gives a light's radiance.
constexpr const char* FuzzedRadianceArray = "Glow";

/**
 * Up to 24 points of several types, or none; vertices, lines, polygons and strips whose ids are
 * mostly those of points; cell arrays of several types and sizes; field data with or without the
 * settings of receivers and lights, some of a wrong type or size.
 */
vtkSmartPointer<vtkPolyData> MakePolyData(ByteReader& bytes);

#endif
