// SPDX-License-Identifier: Apache-2.0
// The laws of the kind `ik`, for every plugin of the build times every arm of configs/robots and
// every URDF arm of tests/data: one test each. A robot that the plugin refuses is not served; a
// plugin that needs parameters is left to its own test. That nothing stays behind when the library
// is unloaded is a law of the plugin, and asked with the first robot that it serves.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "armature/config/problems.hpp"
#include "armature/kinds/ik/contract.hpp"
#include "armature/kinds/ik/verify/plugin_subject.hpp"
#include "armature/robot/files/urdf_robot.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;
using RobotPtr = std::shared_ptr<const RobotModel>;

/// Such a file is an arm that has one of its own, with another tool.
bool includes_another(const fs::path& robot_file) {
  std::ifstream file{robot_file};
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("include:")) return true;
  }
  return false;
}

/// A robot that is read once a test needs it.
struct RobotFile {
  std::string name;
  std::function<RobotPtr()> read;
};

std::vector<RobotFile> robots() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator{ARMATURE_SOURCE_DIR "/configs/robots"}) {
    if (entry.path().extension() != ".yaml" || includes_another(entry.path())) continue;
    files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::vector<RobotFile> list;
  for (const auto& file : files) {
    list.push_back({file.stem().string(),
                    [file] { return std::make_shared<const RobotModel>(load_robot_model(file)); }});
  }
  for (const auto& [name, tip] : {std::pair{"skew_puma", "tool0"}, {"seven_joints", "hand"}}) {
    const std::string file = std::string{ARMATURE_SOURCE_DIR "/tests/data/urdf/"} + name + ".urdf";
    list.push_back(
        {name, [file, tip] {
           return std::make_shared<const RobotModel>(load_urdf_robot(file, {"", {}}, {tip, {}}));
         }});
  }
  return list;
}

/// nullopt when some parameter has no default.
std::optional<Params> defaults(const PluginManifest& plugin) {
  config::Problems problems;
  Params params = Params::read(plugin.params, nullptr, plugin.id, problems);
  if (!problems.empty()) return std::nullopt;
  return params;
}

class LawTest : public testing::Test {
 public:
  explicit LawTest(std::function<void()> body) : body_{std::move(body)} {}
  void TestBody() override { body_(); }

 private:
  std::function<void()> body_;
};

void add_test(const std::string& suite, std::string_view name, std::function<void()> body) {
  testing::RegisterTest(suite.c_str(), std::string{name}.c_str(), nullptr, nullptr, __FILE__,
                        __LINE__, [body] { return new LawTest{body}; });
}

/// Whether the filter of the command line may choose a test of this suite. CTest runs each test as
/// a program of its own, which has no use for the solvers of the others.
bool is_wanted(const std::string& suite) {
  const std::string filter = GTEST_FLAG_GET(filter);
  const bool names_one = filter.find_first_of("*?:-") == std::string::npos;
  return !names_one || filter.starts_with(suite + ".");
}

/// A spindle has no poses to reach.
bool has_poses(const RobotPtr& robot) { return robot->dof() > 1; }

/// None for a robot that the plugin refuses.
void add_tests_of(const PluginManifest& plugin, const Params& params, const RobotFile& file) {
  std::string suite = plugin.id + "_" + file.name;
  std::ranges::replace(suite, '/', '_');
  if (!is_wanted(suite)) return;
  const RobotPtr robot = file.read();
  if (!has_poses(robot)) return;
  // Made anew in every test: no library is held while none of its tests runs.
  const auto subject = [&plugin, params, robot] {
    auto made = plugin_subject(built_plugins(), plugin, robot, params);
    // Without that promise any answer will do there, which fewer questions show.
    if (made && !made->any_seed_at_edges) made->edge_poses = 200;
    return made;
  };
  if (!subject()) return;
  for (const IkLaw& law : ik_laws()) {
    add_test(suite, law.name, [law, subject] { expect_kept(law, subject().value()); });
  }
}

void add_loading_test(const PluginManifest& plugin, const Params& params,
                      const std::vector<RobotFile>& robots) {
  add_test("unloading", plugin.id, [&plugin, params, robots] {
    for (const RobotFile& file : robots) {
      const RobotPtr robot = file.read();
      if (!has_poses(robot) || !plugin_subject(built_plugins(), plugin, robot, params)) continue;
      const LawReport report =
          check_loading({ARMATURE_PLUGIN_BUILD_DIR}, plugin.id, *robot, params, 100);
      for (const auto& [what, question] : report.violations) ADD_FAILURE() << what;
      return;
    }
    FAIL() << "it serves no robot";
  });
}

void add_all_tests() {
  const std::vector<RobotFile> all = robots();
  for (const PluginManifest& plugin : built_plugins().plugins()) {
    if (plugin.kind != IkSolver::kKind) continue;
    add_test("provides", plugin.id, [&plugin] { EXPECT_EQ(wrong_promises(plugin), ""); });
    const auto params = defaults(plugin);
    if (!params) continue;
    add_loading_test(plugin, *params, all);
    for (const RobotFile& robot : all) add_tests_of(plugin, *params, robot);
  }
}

}  // namespace
}  // namespace armature

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  armature::add_all_tests();
  return RUN_ALL_TESTS();
}
