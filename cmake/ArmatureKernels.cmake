# SPDX-License-Identifier: Apache-2.0
# Arithmetic in lanes of doubles (framework/armature/kinds/ik/lanes.hpp), compiled once for each kind of processor.
#
#   armature_add_kernels(ik/puma_algebraic arm_kernel avx2 avx512)
#
# compiles arm_kernel_body.hpp behind arm_kernel.hpp as `portable` and for the named processors, each into the
# namespace armature::ARMATURE_PROCESSOR. What the body includes of the standard library and of Eigen, arm_kernel.hpp
# or the template kernel.cpp.in must include before: that is compiled for every processor.

function(armature_add_kernels id name)
  string(REPLACE "/" "_" target "${id}")
  if(NOT TARGET ${target})  # it is left out
    return()
  endif()
  set(lanes_of_avx2 "avx2,fma")
  set(macros_of_avx2 "#define ARMATURE_AVX")
  set(lanes_of_avx512 "avx512f,avx512dq,avx512vl,avx2,fma")
  set(macros_of_avx512 "#define ARMATURE_AVX\n#define ARMATURE_AVX512")
  foreach(processor portable ${ARGN})
    set(begin "")
    set(end "")
    if(NOT processor STREQUAL "portable")
      set(begin "#if defined(__x86_64__)\n#pragma GCC push_options\n#pragma GCC target(\"${lanes_of_${processor}}\")\n${macros_of_${processor}}")
      set(end "#pragma GCC pop_options\n#endif")
    endif()
    set(source "${CMAKE_CURRENT_BINARY_DIR}/${name}_${processor}.cpp")
    configure_file("${Armature_SOURCE_DIR}/cmake/kernel.cpp.in" "${source}" @ONLY)
    target_sources(${target} PRIVATE "${source}")
    # Compiled by itself; and a long straight line of arithmetic, whose order decides how much of it waits.
    set_source_files_properties("${source}" PROPERTIES
      SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON
      COMPILE_OPTIONS "$<$<AND:$<COMPILE_LANG_AND_ID:CXX,GNU>,$<CONFIG:Release,RelWithDebInfo>>:-O3;-fschedule-insns;-fsched-pressure>")
  endforeach()
endfunction()
