# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Finds ParaView, past what Debian's packages of it get wrong.

# From Debian 13 on, the packages rename every wrapped Python module (X.so to X.cpython-313-....so) after CMake
# has exported the old names, and find_package() stops at targets whose files do not exist. Nothing here links to
# them. CMake 3.28 and later, which those releases have, takes a target whose "xcframework" is a folder as it is.
file(GLOB exports
  "${ParaView_DIR}/ParaViewPython*-targets.cmake"
  "${ParaView_DIR}/vtk/VTKPython-targets.cmake"
  "/usr/lib/*/cmake/paraview-*/ParaViewPython*-targets.cmake"
  "/usr/lib/*/cmake/paraview-*/vtk/VTKPython-targets.cmake"
  "/usr/lib/*/cmake/vtk-*/VTKPython-targets.cmake")
foreach(export IN LISTS exports)
  file(STRINGS "${export}" lines REGEX "^add_library\\([A-Za-z0-9_:]+Python ")
  foreach(line IN LISTS lines)
    if(line MATCHES "^add_library\\(([A-Za-z0-9_:]+) ")
      set("_cmake_import_check_xcframework_for_${CMAKE_MATCH_1}" "${CMAKE_CURRENT_LIST_DIR}")
    endif()
  endforeach()
endforeach()

# Without COMPONENTS, the package asks for Qt.
find_package(ParaView 5.11 REQUIRED COMPONENTS RemotingViews WrapClientServer ProcessXML)

# ParaView 5.13 links to these and does not look for them.
foreach(library IN ITEMS hdf5::hdf5 hdf5::hdf5_hl NetCDF::NetCDF)
  if(NOT TARGET ${library})
    add_library(${library} INTERFACE IMPORTED)
  endif()
endforeach()
