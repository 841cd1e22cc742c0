# SPDX-License-Identifier: Apache-2.0
# libturbojpeg as a target. Debian's libjpeg-turboConfig.cmake also asks for packages that are not used here.
find_path(TURBOJPEG_INCLUDE_DIR turbojpeg.h REQUIRED)
find_library(TURBOJPEG_LIBRARY turbojpeg REQUIRED)
add_library(turbojpeg::turbojpeg UNKNOWN IMPORTED)
set_target_properties(turbojpeg::turbojpeg PROPERTIES
  IMPORTED_LOCATION "${TURBOJPEG_LIBRARY}"
  INTERFACE_INCLUDE_DIRECTORIES "${TURBOJPEG_INCLUDE_DIR}")
