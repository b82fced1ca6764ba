# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Lets find_package() take Debian's VTK and ParaView, whose exported Python targets name files that are not there.

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
