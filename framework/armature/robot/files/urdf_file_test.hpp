// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "armature/robot/files/urdf_robot.hpp"
#include "armature/values/temporary_folder.hpp"
#include "tests/refusal.hpp"

namespace armature::testing {

namespace fs = std::filesystem;

/// A folder with arm.urdf, and what is said of it; its own name does not matter.
class UrdfFile : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    std::ofstream{folder_ / name} << text;
  }
  /// Line 1: <robot>, then three lines a joint and link; `second` is the second joint's inside.
  static std::string arm(const std::string& type, const std::string& second) {
    return "<robot name='arm'><link name='base_link'/>\n"
           "<joint name='j1' type='revolute'><parent link='base_link'/><child link='l1'/>"
           "<limit lower='-1' upper='1' effort='1' velocity='2'/></joint><link name='l1'/>\n"
           "<joint name='j2' type='" +
           type + "'><parent link='l1'/><child link='hand'/>" + second +
           "</joint><link name='hand'/>\n"
           "</robot>\n";
  }
  std::vector<std::string> problems_of(const std::string& text, const std::string& base = "",
                                       const std::string& tip = "hand") const {
    write("arm.urdf", text);
    return problems_when([&] {
      load_urdf_robot(folder_ / "arm.urdf", {base, {"--base", 0, 0}}, {tip, {"--tip", 0, 0}});
    });
  }
  template <class Load>
  std::vector<std::string> problems_when(Load load) const {
    std::vector<std::string> texts = test::problems_of(load);
    for (std::string& text : texts) {
      const std::string folder = folder_.path().string() + "/";
      for (auto at = text.find(folder); at != text.npos; at = text.find(folder))
        text.erase(at, folder.size());
    }
    return texts;
  }
  RobotModel robot(const std::string& yaml) const {
    write("arm.yaml", yaml);
    return load_robot_model(folder_ / "arm.yaml");
  }

  const TemporaryFolder folder_;
};

}  // namespace armature::testing
