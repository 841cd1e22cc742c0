// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "armature/config/document.hpp"
#include "armature/config/reader.hpp"
#include "armature/robot/frame_reader.hpp"
#include "armature/robot/joint_reader.hpp"
#include "armature/robot/quantity_reader.hpp"
#include "armature/robot/robot_model.hpp"

namespace armature {
namespace {

using config::MapReader;
using config::Node;
using config::Problems;
using Eigen::Vector3d;

std::optional<Vector3d> read_pointing_axis(MapReader& map, Problems& problems) {
  static const std::map<std::string, Vector3d, std::less<>> kNamed{
      {"x", Vector3d::UnitX()},   {"y", Vector3d::UnitY()},   {"z", Vector3d::UnitZ()},
      {"-x", -Vector3d::UnitX()}, {"-y", -Vector3d::UnitY()}, {"-z", -Vector3d::UnitZ()}};
  const Node* node = map.optional_node("pointing_axis");
  if (!node) return std::nullopt;
  if (node->kind() == Node::Kind::sequence) {
    const auto axis = read_quantity(map, {"pointing_axis"}, 3, problems).vector();
    if (!axis) return std::nullopt;
    if (axis->norm() > 1e-6) return axis->normalized();
    map.problem("pointing_axis", "'pointing_axis' has no length");
    return std::nullopt;
  }
  const auto named = kNamed.find(node->text());
  if (named != kNamed.end()) return named->second;
  map.problem(
      "pointing_axis",
      fmt::format("'pointing_axis' must be x, y, z, -x, -y, -z or a list of 3 numbers, not {}",
                  node->describe()));
  return std::nullopt;
}

std::optional<FrameId> find_tool(MapReader& map, const std::vector<NamedFrame>& frames,
                                 const std::vector<Joint>& joints) {
  const auto tool = std::ranges::find(frames, "tool", &NamedFrame::name);
  if (tool != frames.end()) return FrameId{static_cast<int>(tool - frames.begin())};
  if (joints.empty()) return std::nullopt;
  map.problem("frames", fmt::format("there is no frame 'tool', for which goals are stated; add "
                                    "frames: {{tool: {{parent: {}}}}}",
                                    joints.back().name));
  return std::nullopt;
}

/// The home position of all joints; empty when none is written or it is wrong.
Quantity read_home(MapReader& map, const std::vector<Joint>& joints, Problems& problems) {
  Quantity home = read_quantity(map, {"home_deg", "home"}, 0, problems);
  if (!home.node || joints.empty()) return home;
  const auto prismatic = std::ranges::find(joints, Joint::Type::prismatic, &Joint::type);
  if (home.key == "home_deg" && prismatic != joints.end())
    map.problem(home.key, fmt::format("'home_deg' cannot state the prismatic joint '{}'; write "
                                      "'home' in radians and metres",
                                      prismatic->name));
  if (!home.si.empty() && home.si.size() != joints.size()) {
    map.problem(home.key, fmt::format("'{}' needs a value for each of the {} joints, not {}",
                                      home.key, joints.size(), home.si.size()));
    home.si.clear();
  }
  return home;
}

/// In what a user's file says: degrees or metres.
std::string in_file_units(double value, bool revolute) {
  return revolute ? fmt::format("{:.6g} deg", value * 180 / std::numbers::pi)
                  : fmt::format("{:.6g} m", value);
}

/// What only shows when all joints are together: couplings that leave no room, a home out of reach.
void check_whole(const RobotModel& model, MapReader& map, const Quantity& home) {
  for (int i = 0; i < model.dof(); ++i)
    if (!(model.lower()[i] < model.upper()[i]))
      map.problem(
          "joints",
          fmt::format("joint '{}' has no room to move: its limits and those of the joints "
                      "that follow it exclude each other",
                      model.joints()[static_cast<std::size_t>(model.independent_joint(i))].name));
  if (!model.home()) return;
  const auto independent = model.contract(*model.home());
  if (!independent) {
    map.problem(home.key, fmt::format("'{}': {}", home.key, independent.error().text));
    return;
  }
  for (int i = 0; i < model.dof(); ++i) {
    const double q = (*independent)[i];
    if (q >= model.lower()[i] && q <= model.upper()[i]) continue;
    const bool revolute = model.is_revolute(i);
    map.problem(
        home.key,
        fmt::format("'{}': {} = {} is outside of {} to {}", home.key,
                    model.joints()[static_cast<std::size_t>(model.independent_joint(i))].name,
                    in_file_units(q, revolute), in_file_units(model.lower()[i], revolute),
                    in_file_units(model.upper()[i], revolute)));
  }
}

std::optional<RobotModel> read(const Node& document, Problems& problems) {
  MapReader map{document, "robot", problems};
  check_format(map, "armature_robot", problems);
  const std::string name = map.text("name");
  const bool modified =
      map.choice("convention", {"standard", "modified"}, "standard") == "modified";
  const Node* joint_list = map.node("joints");
  const auto joints = joint_list ? read_joints(*joint_list, problems) : std::vector<Joint>{};
  const Node* frame_map = map.optional_node("frames");
  const auto frames =
      frame_map ? read_frames(*frame_map, joints, problems) : std::vector<NamedFrame>{};
  const auto tool = find_tool(map, frames, joints);
  const auto axis = read_pointing_axis(map, problems);
  const Quantity home = read_home(map, joints, problems);
  map.finish();
  if (!problems.empty() || !tool) return std::nullopt;

  std::optional<JointVector> home_all;
  if (home.node) {
    home_all.emplace(static_cast<Eigen::Index>(home.si.size()));
    std::ranges::copy(home.si, home_all->begin());
  }
  RobotModel model{
      name,    modified ? RobotModel::Convention::modified : RobotModel::Convention::standard,
      joints,  frames,
      *tool,   axis,
      home_all};
  check_whole(model, map, home);
  if (!problems.empty()) return std::nullopt;
  return model;
}

}  // namespace

RobotModel read_robot_model(const Node& document) {
  Problems problems;
  auto model = read(document, problems);
  problems.throw_if_any();
  return std::move(*model);
}

RobotModel load_robot_model(const std::filesystem::path& file) {
  return read_robot_model(config::load(file));
}

}  // namespace armature
