# SPDX-License-Identifier: Apache-2.0
# armature_add_kernel: a source of long straight arithmetic, compiled by itself for every processor
# and once more for each kind that is named, avx2 or avx512.
#
#   armature_add_kernel(ik/puma_algebraic arm_kernel.cpp HEADER arm_kernel.hpp FOR avx2 avx512)
#
# The source keeps all that it defines unnamed (armature/kinds/ik/lanes.hpp) but for functions
# ARMATURE_FOR_PROCESSOR(name), which become portable_name, avx2_name, avx512_name. HEADER declares
# them and whatever inline functions the source shares with others: those stay every processor's.

function(armature_add_kernel id source)
  cmake_parse_arguments(arg "" "HEADER" "FOR" ${ARGN})
  string(REPLACE "/" "_" target "${id}")
  get_filename_component(name "${source}" NAME_WE)
  set(KERNEL_SOURCE "${CMAKE_CURRENT_SOURCE_DIR}/${source}")
  set(KERNEL_HEADER "${CMAKE_CURRENT_SOURCE_DIR}/${arg_HEADER}")
  foreach(KERNEL_PROCESSOR portable ${arg_FOR})
    set(KERNEL_BEGIN "")
    set(KERNEL_CONDITION "1")
    if(NOT KERNEL_PROCESSOR STREQUAL "portable")
      set(KERNEL_CONDITION "defined(__x86_64__)")
      set(KERNEL_BEGIN "#pragma GCC target(\"avx2,fma\")\n#define ARMATURE_AVX")
    endif()
    if(KERNEL_PROCESSOR STREQUAL "avx512")
      string(APPEND KERNEL_BEGIN "\n#pragma GCC target(\"avx512f,avx512dq,avx512vl\")"
                                 "\n#define ARMATURE_AVX512")
    endif()
    set(generated "${CMAKE_CURRENT_BINARY_DIR}/${name}_${KERNEL_PROCESSOR}.cpp")
    configure_file("${CMAKE_CURRENT_FUNCTION_LIST_DIR}/kernel.cpp.in" "${generated}" @ONLY)
    target_sources(${target} PRIVATE "${generated}")
    set_source_files_properties("${generated}" PROPERTIES
      SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON
      # The order of straight lines of arithmetic decides how much of it waits.
      COMPILE_OPTIONS "$<$<AND:$<COMPILE_LANG_AND_ID:CXX,GNU>,$<CONFIG:Release,RelWithDebInfo>>:-O3>")
  endforeach()
  target_include_directories(${target} PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}")
endfunction()
