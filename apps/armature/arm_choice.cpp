// SPDX-License-Identifier: Apache-2.0
#include "arm_choice.hpp"

#include <fmt/format.h>

#include "armature/config/document.hpp"
#include "armature/config/problems.hpp"
#include "armature/robot/files/urdf_robot.hpp"
#include "exit_code.hpp"

namespace armature {

RobotModel load_arm(const ArmChoice& arm) {
  if (std::filesystem::path{arm.robot}.extension() == ".urdf") {
    return load_urdf_robot(arm.robot, {arm.base, {"--base", 0, 0}}, {arm.tip, {"--tip", 0, 0}});
  }
  if (!arm.base.empty()) {
    throw InvalidChoice(fmt::format(
        "--base names a link of a URDF file; where '{}' stands is written in it", arm.robot));
  }
  RobotModel robot = load_robot_model(arm.robot);
  if (arm.tip.empty() || arm.tip == robot.frame(robot.tool()).name) return robot;
  const auto tip = robot.find_frame(arm.tip);
  if (!tip) {
    std::vector<std::string> names;
    for (const NamedFrame& frame : robot.frames()) names.push_back(frame.name);
    throw InvalidChoice(fmt::format("robot '{}' has no frame '{}'{}", robot.name(), arm.tip,
                                    config::did_you_mean(arm.tip, names)));
  }
  // 'tool' and the tip's link are one place of a URDF arm.
  const NamedFrame &wanted = robot.frame(*tip), &tool = robot.frame(robot.tool());
  if (wanted.parent_joint == tool.parent_joint &&
      wanted.parent_T_frame.matrix() == tool.parent_T_frame.matrix()) {
    return robot;
  }
  // The pointing axis is one of the tool frame; another tip is given as a full rotation.
  RobotParts parts = robot.parts();
  parts.tool = *tip;
  parts.pointing_axis.reset();
  return parts;
}

Params params_of(const PluginManifest& plugin, const std::string& given) {
  config::Problems problems;
  const config::Node values = config::parse_text(given, "--params");
  const bool none = values.kind() == config::Node::Kind::null;
  Params params = Params::read(plugin.params, none ? nullptr : &values, plugin.id, problems);
  problems.throw_if_any();
  return params;
}

}  // namespace armature
