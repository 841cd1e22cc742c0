// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>

#include "arm_choice.hpp"
#include "armature/runtime/output_folder.hpp"
#include "armature/runtime/plugin_registry.hpp"
#include "armature/runtime/write_atomically.hpp"
#include "exit_code.hpp"
#include "plugins.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kKind = "ik";  // of which there is a template

// The files of a new plugin; @ID@, @NAME@, @CLASS@, @TARGET@, @PACKAGE@ and @CONFIGS@ are
// filled in.
constexpr std::string_view kCMake = R"(cmake_minimum_required(VERSION 3.25)
project(@TARGET@ LANGUAGES CXX)
find_package(Armature REQUIRED HINTS "@PACKAGE@")
armature_add_plugin(@ID@ SOURCES @NAME@.cpp LINK armature::ik TESTS @NAME@_test.cpp)
)";

constexpr std::string_view kManifest = R"(armature_plugin: 1
id: @ID@
kind: ik
doc: Damped least squares from the seed, one branch.
params:
  damping: {type: number, default: 0.01, min: 0, doc: "lambda of J^T (J J^T + lambda e^2 I)^-1 e, e the error in m and rad"}
# What you promise, once you do; `armature plugin verify @ID@` checks it:
# offers:
#   any_seed: {doc: "What joints within limits reach is found from any seed."}
#   all_branches: {doc: "Every joint position that reaches the goal is found."}
)";

constexpr std::string_view kSource = R"(#include <Eigen/Cholesky>

#include "armature/kinds/ik/ik.hpp"
#include "armature/robot/task_error.hpp"
#include "armature/runtime/plugin.hpp"
using namespace armature;

/// Damped least squares from the seed (Wampler 1986; Nakamura and Hanafusa 1986).
class @CLASS@ final : public IkSolver {
 public:
  @CLASS@(const RobotModel& robot, const Params& params)
      : robot_{robot}, damping_{params.number("damping")} {}

  IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                 IkState&) const override {
    out.clear();
    if (const char* wrong = invalid_input(robot_, goal, seed))
      return {IkStatus::Code::invalid_input, 0, wrong};
    const auto [position_m, angle_rad] = goal.tolerance;
    JointVector q = seed;
    TaskError e = task_error(robot_, q, goal.pose);
    for (int i = 0; i < goal.max_iterations && !e.within(position_m, angle_rad); ++i) {
      Eigen::Matrix<double, -1, -1, 0, 6, 6> A = e.jacobian.lazyProduct(e.jacobian.transpose());
      A.diagonal().array() += damping_ * e.error.squaredNorm() + 1e-12;
      q += e.jacobian.transpose().lazyProduct(A.llt().solve(e.error));
      e = task_error(robot_, q, goal.pose);
    }
    if (!e.within(position_m, angle_rad))
      return {IkStatus::Code::no_convergence, e.error.norm(), "the seed leads elsewhere"};
    out.add() = branch_at(robot_, goal, q, "from_seed");
    if (out.begin()->within_limits) return {};
    return {IkStatus::Code::joint_limit, 0, "the solution leaves the joint limits"};
  }

 private:
  const RobotModel& robot_;
  double damping_;
};
ARMATURE_PLUGIN(@CLASS@);
)";

constexpr std::string_view kTest = R"(// Every law of the kind, on the arm in arm.urdf.
#include <cstdio>

#include "armature/config/problems.hpp"
#include "armature/kinds/ik/verify/plugin_subject.hpp"
#include "armature/robot/urdf_robot.hpp"

using namespace armature;

int main(int, char** argv) {
  PluginRegistry plugins;  // ctest sets ARMATURE_PLUGIN_PATH to where the plugin was built
  const PluginManifest* plugin = plugins.find("@ID@");
  if (!plugin) return std::puts(plugins.unknown_text("@ID@").c_str()), 1;
  config::Problems problems;
  const Params params = Params::read(plugin->params, nullptr, plugin->id, problems);
  const LinkName root, tool{"tool0", {}};
  const auto arm = std::make_shared<const RobotModel>(load_urdf_robot("arm.urdf", root, tool));
  IkSubject subject = plugin_subject(plugins, *plugin, arm, params).value();
  subject.poses = subject.edge_poses = 200;
  int broken = 0;
  for (const IkLaw& law : ik_laws()) {
    const IkLawReport report = check_law(law, subject);
    std::printf("%s: %d of %d answers break it\n", law.name.data(), report.failed, report.goals);
    for (const auto& [what, question] : report.violations) std::puts(what.c_str());
    broken += report.failed;
  }
  return broken == 0 ? 0 : 1;
}
)";

constexpr std::string_view kReadme = R"(# @ID@

An inverse kinematics solver for Armature: damped least squares from the seed, dq = J^T (J J^T + lambda e^2 I)^-1 e.

    cmake -B build -DCMAKE_BUILD_TYPE=Release && cmake --build build && ctest --test-dir build
    export ARMATURE_PLUGIN_PATH=$PWD/build
    armature plugin verify @ID@ --robot arm.urdf --tip tool0
    armature bench ik --robot arm.urdf --tip tool0 --plugins @ID@,ik/kdl,ik/numeric --poses 10000 --seed 1 --out bench
    armature run @CONFIGS@/dental_lamp.yaml --set components.motion.ik.plugin=@ID@ --set clock=simulated

| file | what |
|---|---|
| `@NAME@.cpp` | the solver, and the line that registers it |
| `plugin.yaml` | id, kind, parameters, what the plugin promises |
| `@NAME@_test.cpp` | every law of the kind as a test |
| `arm.urdf` | an arm to try it with: put your own here |
)";

void replace_all(std::string& text, std::string_view mark, std::string_view value) {
  for (auto at = text.find(mark); at != std::string::npos;
       at = text.find(mark, at + value.size())) {
    text.replace(at, mark.size(), value);
  }
}

std::string class_name(std::string_view name) {
  std::string result;
  bool upper = true;
  for (const char c : name) {
    if (c != '_') result += upper ? static_cast<char>(std::toupper(c)) : c;
    upper = c == '_';
  }
  return result;
}

/// lib/cmake/Armature of the installation, or the build folder, that this program belongs to.
fs::path package_folder() {
  const fs::path program = fs::canonical("/proc/self/exe");
  const fs::path prefix = program.parent_path().parent_path();
  return fs::exists(prefix / "ArmatureConfig.cmake") ? prefix
                                                     : prefix / "lib" / "cmake" / "Armature";
}

}  // namespace

int new_plugin(const std::string& id, const fs::path& directory) {
  const auto slash = id.find('/');
  const std::string name = slash == std::string::npos ? "" : id.substr(slash + 1);
  const bool valid = !name.empty() && std::islower(static_cast<unsigned char>(name.front())) &&
                     std::all_of(name.begin(), name.end(), [](unsigned char c) {
                       return std::islower(c) || std::isdigit(c) || c == '_';
                     });
  const std::string kind = id.substr(0, slash);
  if (slash != std::string::npos && kind != "ik") {
    throw InvalidChoice(fmt::format(
        "there is no template for a plugin of kind '{}', only for 'ik'; begin with a copy "
        "of a plugin of that kind, see plugins/ in the sources",
        kind));
  }
  if (!valid || slash == std::string::npos) {
    throw InvalidChoice(
        fmt::format("'{}' must be 'ik/name', the name in lower case letters, digits and '_'", id));
  }
  const PluginRegistry plugins;
  if (const PluginManifest* there = plugins.find(id)) {
    throw InvalidChoice(fmt::format("there is a plugin '{}' already, '{}'; choose another name", id,
                                    there->file.string()));
  }
  if (fs::exists(directory) && !fs::is_empty(directory)) {
    throw InvalidChoice(fmt::format("'{}' is there already and not empty", directory.string()));
  }
  prepare_output_folder(directory);
  const auto fill = [&](std::string_view text) {
    std::string filled{text};
    replace_all(filled, "@ID@", id);
    replace_all(filled, "@NAME@", name);
    replace_all(filled, "@CLASS@", class_name(name));
    replace_all(filled, "@TARGET@", "ik_" + name);
    replace_all(filled, "@PACKAGE@", package_folder().string());
    replace_all(filled, "@CONFIGS@", shipped_robot_folder().parent_path().string());
    return filled;
  };
  write_atomically(directory / "CMakeLists.txt", fill(kCMake));
  write_atomically(directory / "plugin.yaml", fill(kManifest));
  write_atomically(directory / (name + ".cpp"), fill(kSource));
  write_atomically(directory / (name + "_test.cpp"), fill(kTest));
  fs::copy_file(shipped_robot_folder() / "arm.urdf", directory / "arm.urdf");
  write_atomically(directory / "README.md", fill(kReadme));
  fmt::print("wrote {}: see {}\n", id, (directory / "README.md").string());
  return kOk;
}

}  // namespace armature
