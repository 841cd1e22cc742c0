# SPDX-License-Identifier: Apache-2.0
# How every target of this project is built: language, warnings, sanitizers, output folders, tests.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
string(REPLACE "-O3" "-O2" CMAKE_CXX_FLAGS_RELEASE "${CMAKE_CXX_FLAGS_RELEASE}")

set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${Armature_BINARY_DIR}/bin")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${Armature_BINARY_DIR}/lib")
set(ARMATURE_PLUGIN_BUILD_DIR "${Armature_BINARY_DIR}/lib/armature/plugins")
set(CMAKE_INSTALL_RPATH "$ORIGIN/../lib;$ORIGIN")

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  # Without these two, what uses a precompiled header is not kept: nearly every file.
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env CCACHE_SLOPPINESS=pch_defines,time_macros "${CCACHE_PROGRAM}")
  add_compile_options($<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fpch-preprocess>)
  set(CMAKE_C_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
endif()

# A build links some hundred programs and plugins; binutils brings a faster linker than its usual one.
find_program(GOLD_LINKER ld.gold)
if(GOLD_LINKER AND NOT ARMATURE_SANITIZE)
  add_link_options(-fuse-ld=gold)
endif()

# What must be the same in every library that shares Eigen objects or plugins (see docs/decisions).
add_library(armature_abi INTERFACE)
add_library(Armature::abi ALIAS armature_abi)
set_target_properties(armature_abi PROPERTIES EXPORT_NAME abi)
target_compile_features(armature_abi INTERFACE cxx_std_20)
target_compile_definitions(armature_abi INTERFACE EIGEN_MAX_ALIGN_BYTES=16
                                                  EIGEN_MALLOC_ALREADY_ALIGNED=1)
target_compile_options(armature_abi INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fno-gnu-unique>)
# Libraries hide what their exported headers do not declare: `namespace armature ARMATURE_EXPORT {`. For
# all others the word means nothing, so that what they compile of a header stays their own.
target_compile_definitions(armature_abi INTERFACE
  "ARMATURE_EXPORT=$<$<BOOL:$<TARGET_PROPERTY:ARMATURE_EXPORTS>>:__attribute__((visibility(\"default\")))>")
target_link_libraries(armature_abi INTERFACE tl::expected fmt::fmt)
target_include_directories(armature_abi INTERFACE $<BUILD_INTERFACE:${Armature_BINARY_DIR}/generated>)

# The compiler collects its garbage too often for a machine that has memory.
add_compile_options($<$<COMPILE_LANG_AND_ID:CXX,GNU>:--param=ggc-min-heapsize=1000000>
                    $<$<COMPILE_LANG_AND_ID:CXX,GNU>:--param=ggc-min-expand=200>)

add_library(armature_warnings INTERFACE)
target_compile_options(armature_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion
  -Wno-missing-field-initializers  # designated initialisers leave the rest to its defaults
  $<$<BOOL:${ARMATURE_WERROR}>:-Werror>)
if(ARMATURE_SANITIZE)
  list(JOIN ARMATURE_SANITIZE "," sanitizers)
  add_compile_options(-fsanitize=${sanitizers} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${sanitizers})
  # A plugin of another project is built as this framework was.
  target_compile_options(armature_abi INTERFACE -fsanitize=${sanitizers} -fno-omit-frame-pointer)
  target_link_options(armature_abi INTERFACE -fsanitize=${sanitizers})
endif()

# Most of a file's compile time is reading Eigen and the standard library: each precompiled once,
# for libraries, for programs, for plugins and for tests. The preset `dev`
# builds without them, so that a forgotten #include is found.
#   armature_precompile(robot libraries)
function(armature_precompile target purpose)
  if(NOT ARMATURE_PRECOMPILE)
    return()
  endif()
  set(precompiled armature_precompiled_${purpose})
  if(NOT TARGET ${precompiled})
    # file(CONFIGURE): written only when it changes, or all that is linked would be linked again.
    file(CONFIGURE OUTPUT "${Armature_BINARY_DIR}/${precompiled}.cpp" CONTENT "// nothing but its header\n")
    add_library(${precompiled} OBJECT "${Armature_BINARY_DIR}/${precompiled}.cpp")
    target_link_libraries(${precompiled} PRIVATE Armature::abi armature_warnings Eigen3::Eigen)
    target_precompile_headers(${precompiled} PRIVATE "${Armature_SOURCE_DIR}/cmake/precompiled.hpp")
    if(purpose STREQUAL "programs")
      target_link_libraries(${precompiled} PRIVATE nlohmann_json::nlohmann_json)
      target_precompile_headers(${precompiled} PRIVATE <nlohmann/json.hpp>)
    endif()
    # The flags must be those of the files that use it.
    if(purpose STREQUAL "libraries")
      set_target_properties(${precompiled} PROPERTIES CXX_VISIBILITY_PRESET hidden ARMATURE_EXPORTS ON)
    elseif(purpose STREQUAL "plugins")
      set_target_properties(${precompiled} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
    endif()
  endif()
  target_precompile_headers(${target} REUSE_FROM ${precompiled})
endfunction()

# A target's files are compiled a few at a time, which makes templates once for them.
#   armature_compile_together(robot 8)
function(armature_compile_together target files)
  if(ARMATURE_TOGETHER)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${files})
  endif()
endfunction()

# armature_add_library(robot SOURCES a.cpp ... HEADERS a.hpp ... LINK Eigen3::Eigen ... PRIVATE yaml-cpp ...)
# A shared library libarmature_<name> with the alias Armature::<name>. HEADERS are those that others may
# include: they are installed, and their tokens make the tag by which a plugin that was built with
# others is refused. Without SOURCES: a library of headers.
function(armature_add_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;HEADERS;LINK;PRIVATE" ${ARGN})
  if(NOT arg_SOURCES)
    add_library(armature_${name} INTERFACE)
    add_library(Armature::${name} ALIAS armature_${name})
    set_target_properties(armature_${name} PROPERTIES EXPORT_NAME ${name})
    target_link_libraries(armature_${name} INTERFACE Armature::abi ${arg_LINK})
    armature_public_headers(${name} "${arg_HEADERS}" "${arg_LINK}" INTERFACE)
    return()
  endif()
  add_library(armature_${name} SHARED ${arg_SOURCES})
  add_library(Armature::${name} ALIAS armature_${name})
  set_target_properties(armature_${name} PROPERTIES EXPORT_NAME ${name} VERSION ${PROJECT_VERSION}
                                                    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
                                                    CXX_VISIBILITY_PRESET hidden ARMATURE_EXPORTS ON)
  target_link_libraries(armature_${name} PUBLIC Armature::abi ${arg_LINK}
                                         PRIVATE $<BUILD_INTERFACE:armature_warnings> ${arg_PRIVATE})
  if(NOT ARMATURE_SANITIZE)  # a symbol that another library hides is found here, not when it is loaded
    target_link_options(armature_${name} PRIVATE LINKER:-z,defs)
  endif()
  armature_precompile(armature_${name} libraries)
  armature_compile_together(armature_${name} 16)
  armature_public_headers(${name} "${arg_HEADERS}" "${arg_LINK}" PUBLIC)
endfunction()

# What every test links: GoogleTest and the flags and the precompiled header of tests.
function(armature_test_main)
  if(TARGET armature_test_main)
    return()
  endif()
  file(CONFIGURE OUTPUT "${Armature_BINARY_DIR}/test_main.cpp" CONTENT "#include <gtest/gtest.h>\n")
  add_library(armature_test_main STATIC "${Armature_BINARY_DIR}/test_main.cpp")
  target_link_libraries(armature_test_main PUBLIC GTest::gmock GTest::gtest GTest::gtest_main)
  target_link_libraries(armature_test_main PUBLIC Armature::abi Eigen3::Eigen
                                           PRIVATE armature_warnings)
  # What takes time when tests run is in the libraries. The tests themselves compile faster with -Og than
  # with -O0 or -O1.
  # There GCC 12 falsely warns of the small buffer inside of std::string.
  target_compile_options(armature_test_main PUBLIC
    $<$<CONFIG:Release,RelWithDebInfo>:-Og> -Wno-array-bounds -Wno-stringop-overflow
    -Wno-stringop-overread -Wno-restrict)
  if(ARMATURE_PRECOMPILE)
    target_precompile_headers(armature_test_main PRIVATE
                              "${Armature_SOURCE_DIR}/tests/precompiled.hpp")
  endif()
  set_target_properties(armature_test_main PROPERTIES POSITION_INDEPENDENT_CODE OFF)
endfunction()

# How the files of a test are compiled, of a program or of what programs share.
function(armature_compile_as_test target)
  armature_test_main()
  target_link_libraries(${target} PUBLIC armature_test_main PRIVATE armature_warnings)
  target_include_directories(${target} PRIVATE "${Armature_SOURCE_DIR}")  # "tests/dds_domain.hpp"
  target_compile_definitions(${target} PRIVATE
    ARMATURE_SOURCE_DIR="${Armature_SOURCE_DIR}" ARMATURE_BINARY_DIR="${Armature_BINARY_DIR}"
    ARMATURE_PLUGIN_BUILD_DIR="${ARMATURE_PLUGIN_BUILD_DIR}")
  if(ARMATURE_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM armature_test_main)
  endif()
  # -fPIC (library) and -fPIE (program) cannot share a precompiled header: the compiler's default can.
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
endfunction()

# armature_add_test_library(command SOURCES command.cpp LINK ...): armature_test_command, what several
# test programs share.
function(armature_add_test_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  add_library(armature_test_${name} STATIC ${arg_SOURCES})
  target_include_directories(armature_test_${name} PUBLIC "${CMAKE_CURRENT_SOURCE_DIR}")
  target_link_libraries(armature_test_${name} PUBLIC ${arg_LINK})
  armature_compile_as_test(armature_test_${name})
  armature_compile_together(armature_test_${name} 16)
endfunction()

# armature_add_test(robot_test SOURCES a_test.cpp ... LINK Armature::robot ... [DEPENDS plugin...])
# One GoogleTest program; every case runs alone and in any order. Its files are compiled a few at a
# time, which reads headers and makes templates once for them; SEPARATELY: they use the same names
# for other things. QUARTERS: of a core that a case keeps busy on the average, 4 unless it waits most
# of the time. LABELS: instead of ARMATURE_TEST_LABEL, that of the folder (tests/CMakeLists.txt).
# Whoever needs a TIMEOUT of its own is long, and begins before all others: what is short
# fills the cores at the end.
function(armature_add_test name)
  if(NOT ARMATURE_BUILD_TESTS)
    return()
  endif()
  cmake_parse_arguments(arg "SEPARATELY" "QUARTERS;TIMEOUT" "SOURCES;LINK;DEPENDS;LABELS" ${ARGN})
  armature_left_out(left_out "${name}" ${arg_LINK})
  if(left_out)
    return()
  endif()
  set(cost 1)
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 60)
    set(cost 0)
  endif()
  if(NOT arg_QUARTERS)
    set(arg_QUARTERS 4)
  endif()
  if(NOT arg_LABELS)
    set(arg_LABELS "${ARMATURE_TEST_LABEL}")
  endif()
  set(timeout_of_all 600)
  if(ARMATURE_SANITIZE)  # which slows everything down
    math(EXPR arg_TIMEOUT "${arg_TIMEOUT} * 5")
    set(timeout_of_all 3000)
  endif()
  add_executable(${name} ${arg_SOURCES})
  armature_compile_as_test(${name})
  target_link_libraries(${name} PRIVATE ${arg_LINK})
  if(NOT arg_SEPARATELY)
    armature_compile_together(${name} 16)
  endif()
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${Armature_BINARY_DIR}/tests")
  if(arg_DEPENDS)
    add_dependencies(${name} ${arg_DEPENDS})
  endif()
  include(GoogleTest)
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST TEST_PREFIX "${name}."
    PROPERTIES TIMEOUT ${arg_TIMEOUT} PROCESSORS ${arg_QUARTERS} COST ${cost} LABELS "${arg_LABELS}")
  if(NOT arg_LABELS MATCHES "^(all|full)$")
    # All of its cases in one go, for `tools/test`: most cases are shorter than the start of a program.
    add_test(NAME ${name} COMMAND ${name} --gtest_brief=1)
    set_tests_properties(${name} PROPERTIES
      TIMEOUT ${timeout_of_all} PROCESSORS ${arg_QUARTERS} COST 1 LABELS program)
  endif()
endfunction()

# armature_add_contract(path [SOURCES sound_path.cpp] LINK Armature::path): laws.cpp and SOURCES, what
# every plugin of a kind keeps; for the tests of the plugins and for `armature plugin verify`.
function(armature_add_contract kind)
  cmake_parse_arguments(arg "" "" "SOURCES;HEADERS;LINK;PRIVATE" ${ARGN})
  armature_add_library(${kind}_contract
    SOURCES laws.cpp ${arg_SOURCES}
    HEADERS contract.hpp laws.hpp ${arg_HEADERS}
    LINK Armature::laws ${arg_LINK}
    PRIVATE ${arg_PRIVATE})
endfunction()
