# SPDX-License-Identifier: Apache-2.0
# dlib as the target dlib::dlib. Debian's own dlib CMake package also asks for the development files of
# every library that dlib was built with (libjpeg among them), which libdlib-dev does not install; what its
# headers call directly are LAPACK and BLAS.
find_path(DLIB_INCLUDE_DIR dlib/image_processing.h REQUIRED)
find_library(DLIB_LIBRARY dlib REQUIRED)
find_library(LAPACK_LIBRARY lapack REQUIRED)
find_library(BLAS_LIBRARY blas REQUIRED)
add_library(dlib::dlib UNKNOWN IMPORTED)
set_target_properties(dlib::dlib PROPERTIES
  IMPORTED_LOCATION "${DLIB_LIBRARY}"
  INTERFACE_INCLUDE_DIRECTORIES "${DLIB_INCLUDE_DIR}"
  INTERFACE_LINK_LIBRARIES "${LAPACK_LIBRARY};${BLAS_LIBRARY}")
