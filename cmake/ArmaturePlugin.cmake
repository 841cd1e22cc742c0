# SPDX-License-Identifier: Apache-2.0
# armature_add_plugin: one line makes a plugin, in this tree and after find_package(Armature).
#
#   armature_add_plugin(ik/lamp_geometric SOURCES lamp_geometric.cpp LINK Armature::ik [TESTS x_test.cpp])
#
# The folder's plugin.yaml (id, kind, parameters, ports) is embedded as constant text, together with
# the ABI tag of the compiler that builds it; both are read without running the library's code. Its
# parameters become `struct Parameters` of the namespace armature::ik::lamp_geometric, in the header
# ik_lamp_geometric_parameters.hpp. The ports of a component become `struct Ports` of its namespace, in
# task_lamp_ports.hpp; the libraries of LINK that armature_add_messages made have their message types.
# VERIFY [options]: in somebody else's project, a test that is `armature plugin verify` with these options.
# TEST_ONLY: for the framework's own tests; kept apart from the plugins and not installed.
# TEST_OPTIONS: of armature_add_test.
# LEVELS x86-64-v3 ...: in this tree, the same again for processors of these levels, each a library of its own in a
# folder of that name beside the plugin, which the runtime loads there instead.

# armature_left_out(result id Armature::runtime opencv::core ...): true, with a line that says so, when
# one of the libraries is not built because of ARMATURE_DDS or ARMATURE_VISION.
function(armature_left_out result id)
  set(${result} OFF PARENT_SCOPE)
  if(NOT DEFINED ARMATURE_DDS OR (ARMATURE_DDS AND ARMATURE_VISION))
    return()
  endif()
  foreach(library ${ARGN})
    if(library MATCHES "::" AND NOT TARGET ${library})
      message(STATUS "${id} is left out: there is no ${library} here")
      set(${result} ON PARENT_SCOPE)
      return()
    endif()
  endforeach()
endfunction()

# armature_header_tags_of(result ik Armature::ik ...): the text of C++ that appends the tags of
# the kind's library and of the named ones to the ABI tag.
function(armature_header_tags_of result kind)
  set(library_of_component runtime)
  set(library_of_transport bus)
  set(library_of_observer dds_observer)
  set(library_of_exchange fast_dds)
  if(DEFINED library_of_${kind})
    set(library ${library_of_${kind}})
  else()
    set(library ${kind})
  endif()
  if(NOT TARGET Armature::${library})
    message(FATAL_ERROR "${CMAKE_CURRENT_SOURCE_DIR}/plugin.yaml: there is no kind '${kind}'")
  endif()
  set(text "")
  foreach(link Armature::${library} ${ARGN})
    string(REGEX REPLACE "^Armature::" "" name "${link}")
    if(TARGET ${link})
      get_target_property(tagged ${link} ARMATURE_TAGGED)
      if(tagged)
        string(APPEND text " \", \" ARMATURE_HEADERS_${name}")
      endif()
    endif()
  endforeach()
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

# armature_ports_of(ports message_headers component task_lamp Armature::task weather_msgs ...): the header of
# the ports, and those of all messages that they may carry; of a pure kind none.
function(armature_ports_of ports message_headers kind target)
  set(headers "")
  set(file "")
  if(kind STREQUAL "component")
    set(file "${CMAKE_CURRENT_BINARY_DIR}/${target}_ports.hpp")
    foreach(link Armature::messages ${ARGN})
      if(TARGET ${link})
        get_target_property(of_library ${link} ARMATURE_MESSAGE_HEADERS)
        if(of_library)
          list(APPEND headers ${of_library})
        endif()
      endif()
    endforeach()
    list(REMOVE_DUPLICATES headers)
  endif()
  set(${ports} "${file}" PARENT_SCOPE)
  set(${message_headers} "${headers}" PARENT_SCOPE)
endfunction()

# The library of the plugin that armature_add_plugin adds, or of one level of it.
macro(armature_add_plugin_library library)
  add_library(${library} MODULE ${arg_SOURCES} "${parameters}" ${ports}
                                "${CMAKE_CURRENT_BINARY_DIR}/${target}_manifest.cpp")
  target_include_directories(${library} PRIVATE "${CMAKE_CURRENT_BINARY_DIR}")
  target_link_libraries(${library} PRIVATE Armature::abi ${arg_LINK})
  if(NOT ARMATURE_SANITIZE)  # a missing symbol is found here, not when the plugin is loaded
    target_link_options(${library} PRIVATE LINKER:-z,defs)
  endif()
  set_target_properties(${library} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden
                                              VISIBILITY_INLINES_HIDDEN ON)
endmacro()

# Under a sanitizer the plain library alone is looked at.
macro(armature_add_plugin_levels plugin)
  foreach(level ${ARGN})
    if(ARMATURE_SANITIZE OR NOT CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
      break()
    endif()
    armature_add_plugin_library(${plugin}.${level})
    add_dependencies(${plugin}.${level} armature_header_tags)
    add_dependencies(${plugin} ${plugin}.${level})
    target_compile_options(${plugin}.${level} PRIVATE -march=${level})
    target_link_libraries(${plugin}.${level} PRIVATE armature_warnings)
    set_target_properties(${plugin}.${level} PROPERTIES OUTPUT_NAME ${plugin}
      LIBRARY_OUTPUT_DIRECTORY "${ARMATURE_PLUGIN_BUILD_DIR}/${level}" INSTALL_RPATH "$ORIGIN/../../..")
    install(TARGETS ${plugin}.${level} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/armature/plugins/${level})
  endforeach()
endmacro()

function(armature_add_plugin id)
  cmake_parse_arguments(arg "TEST_ONLY" ""
                        "SOURCES;LINK;TESTS;TEST_LINK;TEST_OPTIONS;VERIFY;LEVELS" ${ARGN})
  string(REPLACE "/" "_" target "${id}")
  list(FIND ARGN VERIFY verify_at)
  armature_left_out(left_out "${id}" ${arg_LINK})
  if(left_out)
    return()
  endif()

  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
                                         "${CMAKE_CURRENT_SOURCE_DIR}/plugin.yaml")
  file(READ "${CMAKE_CURRENT_SOURCE_DIR}/plugin.yaml" ARMATURE_PLUGIN_MANIFEST)
  if(NOT "\n${ARMATURE_PLUGIN_MANIFEST}" MATCHES "\nkind: *([a-z_]+)")
    message(FATAL_ERROR "${CMAKE_CURRENT_SOURCE_DIR}/plugin.yaml: has no line 'kind: ...'")
  endif()
  set(kind "${CMAKE_MATCH_1}")
  armature_header_tags_of(ARMATURE_PLUGIN_HEADERS "${kind}" ${arg_LINK})
  configure_file("${CMAKE_CURRENT_FUNCTION_LIST_DIR}/plugin_manifest.cpp.in" "${CMAKE_CURRENT_BINARY_DIR}/${target}_manifest.cpp"
                 @ONLY)
  # It changes with the tag of any library, the plugin does not: it is compiled alone.
  set_source_files_properties("${CMAKE_CURRENT_BINARY_DIR}/${target}_manifest.cpp" PROPERTIES
                              SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)

  set(parameters "${CMAKE_CURRENT_BINARY_DIR}/${target}_parameters.hpp")
  armature_ports_of(ports message_headers "${kind}" "${target}" ${arg_LINK})
  add_custom_command(OUTPUT "${parameters}" ${ports}
                     COMMAND Armature::parameters plugin.yaml "${parameters}" "${id}" ${ports} ${message_headers}
                     WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}"
                     DEPENDS plugin.yaml Armature::parameters VERBATIM)
  armature_add_plugin_library(${target})
  set(of_the_framework OFF)
  if(PROJECT_NAME STREQUAL "Armature")
    set(of_the_framework ON)
    add_dependencies(${target} armature_header_tags)
  endif()
  if(arg_TEST_ONLY)
    target_link_libraries(${target} PRIVATE armature_warnings)
    set_target_properties(${target} PROPERTIES
      LIBRARY_OUTPUT_DIRECTORY "${Armature_BINARY_DIR}/tests/plugins")
    armature_precompile(${target} plugins)
  elseif(of_the_framework)
    target_link_libraries(${target} PRIVATE armature_warnings)
    set_target_properties(${target} PROPERTIES
      LIBRARY_OUTPUT_DIRECTORY "${ARMATURE_PLUGIN_BUILD_DIR}" INSTALL_RPATH "$ORIGIN/../..")
    install(TARGETS ${target} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/armature/plugins)
    set_property(GLOBAL APPEND PROPERTY ARMATURE_PLUGINS ${target})
    armature_precompile(${target} plugins)
    armature_compile_together(${target} 8)
    armature_add_plugin_levels(${target} ${arg_LEVELS})
    if(arg_TESTS)
      if(TARGET Armature::${kind}_contract)  # the laws of its kind
        list(APPEND arg_TEST_LINK Armature::${kind}_contract)
      endif()
      armature_add_test(${target}_test SOURCES ${arg_TESTS} $<TARGET_OBJECTS:${target}> LINK ${arg_LINK} ${arg_TEST_LINK}
                        DEPENDS ${target} ${arg_TEST_OPTIONS})
      if(TARGET ${target}_test)
        target_include_directories(${target}_test PRIVATE "${CMAKE_CURRENT_BINARY_DIR}")
      endif()
    endif()
  elseif(arg_TESTS)  # of somebody else's project: a program that ends with 0
    add_executable(${target}_test ${arg_TESTS})
    add_dependencies(${target}_test ${target})
    if(TARGET Armature::${kind}_verify)
      list(APPEND arg_TEST_LINK Armature::${kind}_verify)
    elseif(TARGET Armature::${kind}_contract)
      list(APPEND arg_TEST_LINK Armature::${kind}_contract)
    endif()
    target_link_libraries(${target}_test PRIVATE Armature::abi ${arg_LINK} ${arg_TEST_LINK})
    target_include_directories(${target}_test PRIVATE "${CMAKE_CURRENT_BINARY_DIR}")
    add_test(NAME ${target} COMMAND ${target}_test WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
    set_tests_properties(${target} PROPERTIES
      ENVIRONMENT "ARMATURE_PLUGIN_PATH=$<TARGET_FILE_DIR:${target}>")
  endif()
  if(verify_at GREATER -1)
    add_test(NAME ${target}_laws
             COMMAND Armature::cli plugin verify $<TARGET_FILE:${target}> ${arg_VERIFY}
             WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
  endif()
endfunction()
