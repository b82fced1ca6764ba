# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Finds ParaView, past what Debian's packages of it get wrong.

# Without COMPONENTS, the package asks for Qt.
find_package(ParaView 5.11 REQUIRED COMPONENTS RemotingViews WrapClientServer ProcessXML)

# ParaView 5.13 links to these and does not look for them.
foreach(library IN ITEMS hdf5::hdf5 hdf5::hdf5_hl NetCDF::NetCDF)
  if(NOT TARGET ${library})
    add_library(${library} INTERFACE IMPORTED)
  endif()
endforeach()
