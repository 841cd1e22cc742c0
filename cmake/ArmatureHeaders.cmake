# SPDX-License-Identifier: Apache-2.0
# The public headers of the libraries: which they are, where they are installed, and the tags that
# header_tags.cmake makes of them.

# armature_public_headers(robot "model/robot_model.hpp;..." "Armature::config;..." PUBLIC): of the target
# armature_robot, which is installed with them. The libraries that it links are named before it.
function(armature_public_headers name headers links scope)
  set(files "")
  if(headers)
    target_sources(armature_${name} ${scope} FILE_SET HEADERS
                   BASE_DIRS "${Armature_SOURCE_DIR}/framework" FILES ${headers})
    list(TRANSFORM headers PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/" OUTPUT_VARIABLE files)
    set(file_set FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  endif()
  install(TARGETS armature_${name} EXPORT ArmatureTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ${file_set})
  list(FILTER links INCLUDE REGEX "^Armature::")
  list(TRANSFORM links REPLACE "^Armature::" "")
  set_property(GLOBAL APPEND PROPERTY ARMATURE_LIBRARIES ${name})
  set_property(GLOBAL APPEND_STRING PROPERTY ARMATURE_LIBRARY_HEADERS
               "set(${name}_headers \"${files}\")\nset(${name}_links \"${links}\")\n")
  set_property(TARGET armature_${name} PROPERTY ARMATURE_TAGGED ON)
  set_property(TARGET armature_${name} APPEND PROPERTY EXPORT_PROPERTIES ARMATURE_TAGGED)
endfunction()

# armature_tag_also(messages a.idl ...): files that headers of this library are made from.
function(armature_tag_also name)
  set_property(GLOBAL APPEND_STRING PROPERTY ARMATURE_LIBRARY_HEADERS
               "list(APPEND ${name}_headers \"${ARGN}\")\n")
endfunction()

# After the last library: the header with the tags of all of them.
function(armature_tag_headers)
  get_property(libraries GLOBAL PROPERTY ARMATURE_LIBRARIES)
  get_property(text GLOBAL PROPERTY ARMATURE_LIBRARY_HEADERS)
  file(CONFIGURE OUTPUT "${Armature_BINARY_DIR}/libraries.cmake" CONTENT "set(libraries \"${libraries}\")\n${text}" @ONLY)
  include("${Armature_BINARY_DIR}/libraries.cmake")
  foreach(library ${libraries})
    list(APPEND headers ${${library}_headers})
  endforeach()
  set(tags "${Armature_BINARY_DIR}/generated/armature/values/header_tags.hpp")
  set(script "${Armature_SOURCE_DIR}/cmake/header_tags.cmake")
  add_custom_command(OUTPUT "${tags}"
    COMMAND ${CMAKE_COMMAND} -D LIBRARIES=${Armature_BINARY_DIR}/libraries.cmake -D OUTPUT=${tags} -P ${script}
    DEPENDS ${headers} "${script}" "${Armature_BINARY_DIR}/libraries.cmake" VERBATIM)
  add_custom_target(armature_header_tags DEPENDS "${tags}")
  install(FILES "${tags}" DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/armature/values)
endfunction()
