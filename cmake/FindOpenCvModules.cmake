# SPDX-License-Identifier: Apache-2.0
# The OpenCV modules that are used, as targets. OpenCVConfig.cmake stands in libopencv-dev, which would install
# every module with its 180 dependencies.
function(armature_opencv_module module)
  add_library(opencv::${module} UNKNOWN IMPORTED)
  set_target_properties(opencv::${module} PROPERTIES
    IMPORTED_LOCATION "${OPENCV_${module}_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${OPENCV_INCLUDE_DIR}")
endfunction()

find_path(OPENCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
foreach(module core imgproc imgcodecs)
  find_library(OPENCV_${module}_LIBRARY opencv_${module} REQUIRED)
  armature_opencv_module(${module})
endforeach()
# One plugin runs a network: without the module it is left out.
find_library(OPENCV_dnn_LIBRARY opencv_dnn)
if(OPENCV_dnn_LIBRARY AND EXISTS "${OPENCV_INCLUDE_DIR}/opencv2/dnn.hpp")
  armature_opencv_module(dnn)
endif()
