// SPDX-License-Identifier: Apache-2.0
// A new plugin of every family, as `armature plugin new` writes them, built outside this tree in
// one CMake project.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "command.hpp"

namespace armature::test {

class NewPlugins {
 public:
  /// `folder` is made anew; the same one every time, so that a compiler cache knows what it sees.
  explicit NewPlugins(std::filesystem::path folder) : folder_{std::move(folder)} {
    std::filesystem::remove_all(folder_);
    const auto help = run_command({armature(), "plugin", "new", "--help"});
    std::istringstream lines{help.out};
    for (std::string line; std::getline(lines, line);) {
      const auto name = line.find("/...");
      if (line.starts_with("  ") && name != std::string::npos) {
        families_.push_back(line.substr(2, name - 2));
      }
    }
  }

  const std::vector<std::string>& families() const { return families_; }
  /// "ik/my_ik": no two are called alike, so that one deployment can have all.
  static std::string id(const std::string& family) { return family + "/my_" + family; }
  std::filesystem::path folder(const std::string& family) const { return folder_ / family; }
  Command::Options environment() const {
    return {.environment = {{"ARMATURE_PLUGIN_PATH", (folder_ / "build/plugins").string()},
                            {"CCACHE_SLOPPINESS", "pch_defines,time_macros"}},  // see ArmatureBuild
            .input = {}};
  }

  void write() const {
    for (const std::string& family : families_) {
      expect_ok({armature(), "plugin", "new", id(family), "-o", folder(family)});
    }
  }
  /// `precompiled` saves half of the time, and does not see that an #include is missing.
  void build(bool precompiled) const {
    std::ofstream project{folder_ / "CMakeLists.txt"};
    project << "cmake_minimum_required(VERSION 3.25)\nproject(new_plugins LANGUAGES CXX)\n"
               "set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/plugins)\n"
               "find_package(Armature REQUIRED HINTS \"" ARMATURE_BINARY_DIR "\")\n";
    for (const std::string& family : families_) {
      project << "add_subdirectory(" << family << ")\n";
    }
    if (precompiled) project << kPrecompiled;
    project.close();
    const std::string build = folder_ / "build";
    // -O1: the laws of an ik plugin take twenty times as long with -O0.
    expect_ok({CMAKE_PROGRAM, "-G", "Ninja", "-S", folder_, "-B", build,
               "-DCMAKE_CXX_FLAGS=-O1 " ARMATURE_COMPILER_FLAGS,
               "-DCMAKE_CXX_COMPILER_LAUNCHER=" ARMATURE_COMPILER_LAUNCHER});
    expect_ok({CMAKE_PROGRAM, "--build", build, "--parallel", "2"});
  }
  void expect_laws_kept() const {
    expect_ok({CTEST_PROGRAM, "--test-dir", folder_ / "build", "--no-tests=error", "-j", "2",
               "--output-on-failure"});
  }

  void expect_ok(const std::vector<std::string>& command) const {
    const auto result = run_command(command, environment(), std::chrono::seconds{200});
    ASSERT_EQ(result.exit_code, 0) << command[0] << ": " << result.out << result.err;
  }

 private:
  static constexpr const char* kPrecompiled = R"(
file(WRITE ${CMAKE_BINARY_DIR}/precompiled.cpp "")
add_library(precompiled OBJECT ${CMAKE_BINARY_DIR}/precompiled.cpp)
target_link_libraries(precompiled PRIVATE Armature::kinds Armature::trajectory)
set_target_properties(precompiled PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden
                                             VISIBILITY_INLINES_HIDDEN ON)
target_precompile_headers(precompiled PRIVATE <Eigen/Geometry> <functional> <memory> <optional>
  <string> <vector> <armature/kinds/trajectory/trajectory_planner.hpp>
  <armature/runtime/component/setup.hpp>)
get_property(folders DIRECTORY PROPERTY SUBDIRECTORIES)
foreach(folder ${folders})
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target ${targets})
    get_target_property(type ${target} TYPE)
    if(type STREQUAL MODULE_LIBRARY)
      target_precompile_headers(${target} REUSE_FROM precompiled)
    endif()
  endforeach()
endforeach()
)";

  std::filesystem::path folder_;
  std::vector<std::string> families_;
};

}  // namespace armature::test
