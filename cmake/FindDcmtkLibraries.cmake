# SPDX-License-Identifier: Apache-2.0
# The part of DCMTK that reads and writes DICOM files, as the target dcmtk::dcmdata. Debian's own DCMTKConfig.cmake
# asks for the development files of every library that DCMTK was built with (libxml2, libpng, OpenSSL).
find_path(DCMTK_INCLUDE_DIR dcmtk/dcmdata/dctk.h REQUIRED)
add_library(dcmtk::dcmdata INTERFACE IMPORTED)
set_target_properties(dcmtk::dcmdata PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${DCMTK_INCLUDE_DIR}")
foreach(module dcmdata oflog ofstd)
  find_library(DCMTK_${module}_LIBRARY ${module} REQUIRED)
  target_link_libraries(dcmtk::dcmdata INTERFACE "${DCMTK_${module}_LIBRARY}")
endforeach()
