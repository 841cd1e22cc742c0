# SPDX-License-Identifier: Apache-2.0
# Writes header_tags.hpp: of each library, a hash over the tokens of its public headers. Comments and
# blanks do not count. A plugin carries the tags of the libraries that it was compiled with, and is
# refused where one of them differs (armature/runtime/plugins/abi.hpp).
#
#   cmake -D LIBRARIES=libraries.cmake -D OUTPUT=header_tags.hpp -P header_tags.cmake
#
# LIBRARIES sets `libraries`, from the bottom up, and for each of them `<name>_headers`, files, and
# `<name>_links`, the libraries that its headers stand on: the tag of a library covers theirs.
cmake_minimum_required(VERSION 3.25)
include("${LIBRARIES}")

# The tokens of a file, one blank between words and none elsewhere.
function(read_tokens file result)
  file(READ "${file}" text)
  string(REGEX REPLACE "//[^\n]*" "" text "${text}")
  string(REGEX REPLACE "/\\*([^*]|\\*+[^*/])*\\*+/" "" text "${text}")
  string(REGEX REPLACE "[ \t\r\n]+" " " text "${text}")
  string(REGEX REPLACE " ?([^A-Za-z0-9_ ]) ?" "\\1" text "${text}")
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

set(text "// Made by header_tags.cmake.\n#pragma once\n\n")
foreach(library ${libraries})
  set(all "")
  foreach(header ${${library}_headers})
    read_tokens("${header}" tokens)
    string(APPEND all "${tokens}\n")
  endforeach()
  foreach(link ${${library}_links})
    string(APPEND all "${${link}_tag}\n")
  endforeach()
  string(SHA256 hash "${all}")
  string(SUBSTRING "${hash}" 0 12 ${library}_tag)
  string(APPEND text "#define ARMATURE_HEADERS_${library} \"${library} ${${library}_tag}\"\n")
  list(APPEND tags "ARMATURE_HEADERS_${library}")
endforeach()
list(JOIN tags " \\\n  \", \" " tags)
string(APPEND text "\n#define ARMATURE_ALL_HEADERS \\\n  ${tags}\n")
file(CONFIGURE OUTPUT "${OUTPUT}" CONTENT "${text}" @ONLY)
