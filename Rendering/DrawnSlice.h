// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * The rectangles in which slices of images are drawn.
 */
#ifndef DrawnSlice_h
#define DrawnSlice_h

#include "vtkSmartPointer.h"
#include "vtkWeakPointer.h"

#include <map>

class vtkActor;
class vtkProp;

namespace penumbra
{

/// Actors of rectangles that stand for props which draw slices of images.
class SliceActors
{
public:
  /// The actor that stands for the prop, up to date; nullptr if the prop draws no slice that can be
  /// found. Slices that follow the camera are not: they would be baked whenever it moves.
  vtkActor* Find(vtkProp* prop);

  /// Forgets those of props that are gone.
  void Prune();

private:
  struct Entry
  {
    vtkWeakPointer<vtkProp> Prop;
    vtkSmartPointer<vtkActor> Actor;
  };
  std::map<vtkProp*, Entry> Entries;
};

} // namespace penumbra

#endif
