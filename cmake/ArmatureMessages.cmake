# SPDX-License-Identifier: Apache-2.0
# Message types from IDL files, in this tree and after find_package(Armature).
#
#   armature_add_messages(weather_msgs weather.idl [more.idl...])
#
# The shared library weather_msgs, for plugins to link, and the header weather_msgs/weather.hpp with
# weather_msgs::msg::Report of `module weather_msgs { module msg { module dds_ { @final struct Report_`.
# An IDL file may include another one of the list, and "std_msgs.idl" and the other files of the
# framework. The library holds the IDL as text: `armature topic` reads it in the plugin path.
function(armature_add_messages name)
  armature_generate_messages(code HEADER_FOLDER "${name}"
    FOLDERS "$<TARGET_PROPERTY:Armature::idl,INTERFACE_INCLUDE_DIRECTORIES>=armature/messages"
    IDL ${ARGN})
  add_library(${name} SHARED ${code})
  armature_message_headers(${name} "${name}" ${ARGN})
  target_include_directories(${name} PUBLIC "${CMAKE_CURRENT_BINARY_DIR}/generated")
  target_link_libraries(${name} PUBLIC Armature::messages)
  # Samples and topics outlive the plugin that made them, and need the code of their type.
  target_link_options(${name} PRIVATE LINKER:-z,nodelete)
endfunction()

# armature_generate_messages(code HEADER_FOLDER weather_msgs [OUTPUT generated] [ALIAS armature::msg]
#                            [FOLDERS folder=header_folder...] IDL weather.idl ...)
# `code`: the files that are made, a header of each IDL file and one source.
function(armature_generate_messages code)
  cmake_parse_arguments(arg "" "HEADER_FOLDER;OUTPUT;ALIAS" "FOLDERS;IDL" ${ARGN})
  if(NOT arg_OUTPUT)
    set(arg_OUTPUT "${CMAKE_CURRENT_BINARY_DIR}/generated")
  endif()
  if(NOT arg_ALIAS)
    set(arg_ALIAS "-")  # as ROS 2 names it
  endif()
  list(TRANSFORM arg_FOLDERS PREPEND "-I;")
  set(made "${arg_OUTPUT}/${arg_HEADER_FOLDER}/messages.cpp")
  foreach(file ${arg_IDL})
    cmake_path(GET file STEM stem)
    list(APPEND made "${arg_OUTPUT}/${arg_HEADER_FOLDER}/${stem}.hpp")
  endforeach()
  add_custom_command(OUTPUT ${made}
                     COMMAND Armature::message_generator "${arg_OUTPUT}" "${arg_HEADER_FOLDER}"
                             "${arg_ALIAS}" ${arg_FOLDERS} ${arg_IDL}
                     WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}"
                     DEPENDS ${arg_IDL} Armature::message_generator
                     COMMENT "Messages: ${arg_HEADER_FOLDER}"
                     COMMAND_EXPAND_LISTS VERBATIM)
  set(${code} ${made} PARENT_SCOPE)
endfunction()

# armature_message_headers(weather_msgs weather_msgs weather.idl...): which headers the library has, for the
# plugins that link it.
function(armature_message_headers library header_folder)
  foreach(file ${ARGN})
    cmake_path(GET file STEM stem)
    set_property(TARGET ${library} APPEND PROPERTY ARMATURE_MESSAGE_HEADERS "${header_folder}/${stem}.hpp")
  endforeach()
  set_property(TARGET ${library} APPEND PROPERTY EXPORT_PROPERTIES ARMATURE_MESSAGE_HEADERS)
endfunction()
