// SPDX-License-Identifier: Apache-2.0
// What `armature plugin new ik/mine` writes: a solver.
#include "plugin_template.hpp"

namespace armature {
namespace {

constexpr std::string_view kIkCMake = R"(cmake_minimum_required(VERSION 3.25)
project(@TARGET@ LANGUAGES CXX)
find_package(Armature REQUIRED HINTS "@PACKAGE@")
armature_add_plugin(@ID@ SOURCES @NAME@.cpp LINK Armature::ik TESTS @NAME@_test.cpp)
)";

constexpr std::string_view kIkManifest = R"(armature_plugin: 1
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

constexpr std::string_view kIkSource = R"(#include <Eigen/Cholesky>

#include "armature/kinds/ik/ik.hpp"
#include "armature/robot/task_error.hpp"
#include "armature/runtime/plugin.hpp"
#include "@TARGET@_parameters.hpp"  // made from plugin.yaml

namespace @NAMESPACE@ {
/// Damped least squares from the seed (Wampler 1986; Nakamura and Hanafusa 1986).
class @CLASS@ final : public IkSolver {
 public:
  @CLASS@(const RobotModel& robot, const Params& params)
      : robot_{robot}, parameters_{Parameters::read(params)} {}

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
      A.diagonal().array() += parameters_.damping * e.error.squaredNorm() + 1e-12;
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
  Parameters parameters_;
};
}  // namespace @NAMESPACE@
ARMATURE_PLUGIN(@NAMESPACE@::@CLASS@);
)";

constexpr std::string_view kIkTest = R"(// Every law of the kind, on the arm in arm.urdf.
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

constexpr std::string_view kIkReadme = R"(# @ID@

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

constexpr TemplateFile kIkFiles[] = {{"CMakeLists.txt", kIkCMake},
                                     {"plugin.yaml", kIkManifest},
                                     {"@NAME@.cpp", kIkSource},
                                     {"@NAME@_test.cpp", kIkTest},
                                     {"README.md", kIkReadme}};

}  // namespace

const PluginTemplate& ik_template() {
  static constexpr PluginTemplate ik{"ik", "", kIkFiles};
  return ik;
}

}  // namespace armature
