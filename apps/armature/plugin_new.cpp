// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>

#include "exit_code.hpp"
#include "plugins.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kKind = "ik";  // of which there is a template

// The files of a new plugin; @ID@, @NAME@, @CLASS@, @TARGET@ and @PACKAGE@ are filled in.
constexpr std::string_view kCMake = R"(cmake_minimum_required(VERSION 3.25)
project(@TARGET@ LANGUAGES CXX)
find_package(Armature REQUIRED HINTS "@PACKAGE@")
armature_add_plugin(@ID@ SOURCES @NAME@.cpp LINK armature::ik)

enable_testing()
add_executable(@TARGET@_test @NAME@_test.cpp @NAME@.cpp)
target_link_libraries(@TARGET@_test PRIVATE armature::ik)
add_test(NAME @TARGET@ COMMAND @TARGET@_test)
)";

constexpr std::string_view kManifest = R"(armature_plugin: 1
id: @ID@
kind: ik
doc: Damped least squares from the seed, one branch.
params:
  damping: {type: number, default: 0.001, min: 0, doc: "lambda of (J^T J + lambda I) dq = J^T e"}
)";

constexpr std::string_view kHeader = R"(#pragma once

#include "armature/kinds/ik/ik.hpp"

class @CLASS@ final : public armature::IkSolver {
 public:
  @CLASS@(const armature::RobotModel& robot, const armature::Params& params)
      : robot_{robot}, damping_{params.number("damping")} {}

  armature::IkStatus solve(const armature::IkGoal& goal, const armature::JointVector& seed,
                           armature::IkBranches& out, armature::IkState& state) const override;

 private:
  const armature::RobotModel& robot_;
  double damping_;
};
)";

constexpr std::string_view kSource = R"(#include "@NAME@.hpp"

#include <Eigen/Cholesky>

#include "armature/robot/kinematics.hpp"
#include "armature/runtime/plugin.hpp"

using namespace armature;

IkStatus @CLASS@::solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                        IkState&) const {
  out.clear();
  if (const char* wrong = invalid_input(robot_, goal, seed)) {
    return {IkStatus::Code::invalid_input, 0, wrong};
  }
  const Eigen::Vector3d axis = robot_.pointing_axis().value_or(Eigen::Vector3d::UnitZ());
  JointVector q = seed;
  for (int i = 0; i < goal.max_iterations; ++i) {
    auto [base_T_tool, J] = forward_kinematics_with_jacobian(robot_, q, robot_.tool());
    const PoseResidual left = residual(base_T_tool, axis, goal.pose);
    if (left.position_m <= goal.tolerance.position_m && left.angle_rad <= goal.tolerance.angle_rad) {
      const bool inside = robot_.within_limits(q);
      out.add() = {"from_seed", q, 0, left, inside, false};
      return {inside ? IkStatus::Code::ok : IkStatus::Code::joint_limit, 0, "outside its limits"};
    }
    Eigen::Matrix<double, 6, 1> error;
    error.head<3>() = goal.pose.position - base_T_tool.translation();
    if (const auto* direction = std::get_if<Direction>(&goal.pose.orientation)) {
      const Eigen::Vector3d pointing = base_T_tool.rotation() * axis;  // the turn about it is free
      J.bottomRows<3>() -= (pointing * (pointing.transpose() * J.bottomRows<3>())).eval();
      error.tail<3>() = pointing.cross(direction->unit);
    } else {
      const Eigen::AngleAxisd turn{std::get<Eigen::Quaterniond>(goal.pose.orientation) *
                                   Eigen::Quaterniond{base_T_tool.rotation()}.inverse()};
      error.tail<3>() = turn.angle() * turn.axis();
    }
    Eigen::MatrixXd A = J.transpose() * J;
    A.diagonal().array() += damping_ * error.squaredNorm() + 1e-12;
    q += A.ldlt().solve(J.transpose() * error);
  }
  return {IkStatus::Code::no_convergence, 0, "more iterations than the goal allows"};
}

ARMATURE_PLUGIN(@CLASS@);
)";

constexpr std::string_view kTest =
    R"(// fk(ik(x)) = x on an arm of two links.
#include <cstdio>

#include "@NAME@.hpp"
#include "armature/config/problems.hpp"
#include "armature/robot/kinematics.hpp"

using namespace armature;

int main() {
  const Joint base{.name = "j1", .a = 0.4, .lower = -3, .upper = 3, .max_velocity = 1,
                   .max_acceleration = 1, .coupling = {}};
  std::vector<Joint> joints{base, base};
  joints[1].name = "j2";
  const RobotModel robot("two_links", RobotModel::Convention::standard, joints,
                         {{"tool", 1, Eigen::Isometry3d::Identity()}}, FrameId{0},
                         Eigen::Vector3d::UnitX(), std::nullopt);
  config::Problems problems;
  const auto specs = std::vector<ParamSpec>{{.name = "damping", .doc = {},
      .fallback = config::Node::scalar("0.001", false, {}), .min = {}, .max = {}, .choices = {}, .count = {}}};
  const @CLASS@ solver{robot, Params::read(specs, nullptr, "@ID@", problems)};
  const JointVector q = JointVector::Constant(2, 0.7);
  const Eigen::Isometry3d pose = forward_kinematics(robot, q);
  const IkGoal goal{.pose = {pose.translation(), Direction{pose.rotation().col(0)}}, .redundancy = {}};
  IkBranches branches;
  IkState state;
  const IkStatus status = solver.solve(goal, q + JointVector::Constant(2, 0.2), branches, state);
  std::printf("%s\n", describe(status).c_str());
  return status.code == IkStatus::Code::ok ? 0 : 1;
}
)";

constexpr std::string_view kReadme = R"(# @ID@

An inverse kinematics solver for Armature: damped least squares from the seed.

    cmake -B build && cmake --build build && ctest --test-dir build
    export ARMATURE_PLUGIN_PATH=$PWD/build
    armature plugin info @ID@
    armature run dental_lamp.yaml --set components.motion.ik.plugin=@ID@
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

void write(const fs::path& file, std::string text) {
  std::ofstream stream{file};
  stream << text;
  stream.close();
  if (!stream) throw std::runtime_error("cannot write " + file.string());
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
  if (slash != std::string::npos && kind != kKind) {
    throw InvalidChoice(fmt::format(
        "there is no template for a plugin of kind '{}', only for '{}'; begin with a copy "
        "of a plugin of that kind, see plugins/ in the sources",
        kind, kKind));
  }
  if (!valid || slash == std::string::npos) {
    throw InvalidChoice(fmt::format(
        "'{}' must be '{}/name', the name in lower case letters, digits and '_'", id, kKind));
  }
  if (fs::exists(directory) && !fs::is_empty(directory)) {
    throw InvalidChoice(fmt::format("'{}' is there already and not empty", directory.string()));
  }
  fs::create_directories(directory);
  const auto fill = [&](std::string_view text) {
    std::string filled{text};
    replace_all(filled, "@ID@", id);
    replace_all(filled, "@NAME@", name);
    replace_all(filled, "@CLASS@", class_name(name));
    replace_all(filled, "@TARGET@", "ik_" + name);
    replace_all(filled, "@PACKAGE@", package_folder().string());
    return filled;
  };
  write(directory / "CMakeLists.txt", fill(kCMake));
  write(directory / "plugin.yaml", fill(kManifest));
  write(directory / (name + ".hpp"), fill(kHeader));
  write(directory / (name + ".cpp"), fill(kSource));
  write(directory / (name + "_test.cpp"), fill(kTest));
  write(directory / "README.md", fill(kReadme));
  fmt::print("wrote {}: see {}\n", id, (directory / "README.md").string());
  return kOk;
}

}  // namespace armature
