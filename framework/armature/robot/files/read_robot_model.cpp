// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "armature/config/document.hpp"
#include "armature/config/reader.hpp"
#include "armature/robot/files/frame_reader.hpp"
#include "armature/robot/files/joint_reader.hpp"
#include "armature/robot/files/quantity_reader.hpp"
#include "armature/robot/files/urdf_robot.hpp"
#include "armature/robot/model/robot_model.hpp"

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
  const auto independent = model.to_independent(*model.home());
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

/// How a robot is built.
struct Build {
  RobotModel::Convention convention;
  std::vector<Joint> joints;
  std::vector<NamedFrame> frames;
  std::optional<FrameId> tool;
};

/// From the rows in the file itself.
Build read_rows(MapReader& map, Problems& problems) {
  const bool modified =
      map.choice("convention", {"standard", "modified"}, "standard") == "modified";
  Build build{
      modified ? RobotModel::Convention::modified : RobotModel::Convention::standard, {}, {}, {}};
  if (const Node* list = map.node("joints")) build.joints = read_joints(*list, problems);
  if (const Node* frames = map.optional_node("frames"))
    build.frames = read_frames(*frames, build.joints, {}, problems);
  build.tool = find_tool(map, build.frames, build.joints);
  return build;
}

/// Motion needs every joint's speed; URDF may leave a continuous joint's open.
void check_speeds(const std::vector<Joint>& joints, MapReader& map) {
  for (const Joint& joint : joints) {
    if (joint.coupling || std::isfinite(joint.max_velocity)) continue;
    const bool slides = joint.type == Joint::Type::prismatic;
    map.problem("urdf", fmt::format("joint '{0}' has no velocity limit; state it in the URDF file, "
                                    "or here: joints: [{{name: {0}, {1}: 1}}]",
                                    joint.name, slides ? "velocity_m_s" : "velocity_rad_s"));
  }
}

/// From a URDF file; its frames are the links from base to tip, and what the robot file adds.
Build read_urdf(const Node& file, MapReader& map, Problems& problems) {
  const auto link = [](const Node* node, const Node& otherwise) {
    return node ? LinkName{node->text(), node->origin()} : LinkName{"", otherwise.origin()};
  };
  const LinkName base = link(map.optional_node("base"), file);
  const LinkName tip = link(map.node("tip"), file);
  const Node* limits = map.optional_node("joints");
  const Node* more = map.optional_node("frames");
  Build build{RobotModel::Convention::modified, {}, {}, {}};
  if (tip.name.empty()) return build;  // noted as missing
  UrdfArm arm = read_urdf_arm(config::folder_of(file.origin()) / file.text(), base, tip, problems);
  build = {build.convention, std::move(arm.joints), std::move(arm.frames), arm.tip};
  if (build.joints.empty()) return build;
  if (limits) read_other_limits(*limits, build.joints, problems);
  check_speeds(build.joints, map);
  if (!more) return build;
  const auto added = read_frames(*more, {}, build.frames, problems);
  const auto tool = std::ranges::find(added, "tool", &NamedFrame::name);
  if (tool != added.end())
    build.tool = FrameId{
        static_cast<int>(build.frames.size() + static_cast<std::size_t>(tool - added.begin()))};
  build.frames.insert(build.frames.end(), added.begin(), added.end());
  return build;
}

std::optional<RobotModel> read(const Node& document, Problems& problems) {
  MapReader map{document, "robot", problems};
  check_format(map, "armature_robot", problems);
  const std::string name = map.text("name");
  const Node* urdf = map.optional_node("urdf");
  const auto [convention, joints, frames, tool] =
      urdf ? read_urdf(*urdf, map, problems) : read_rows(map, problems);
  const auto axis = read_pointing_axis(map, problems);
  const Quantity home = read_home(map, joints, problems);
  map.finish();
  if (!problems.empty() || !tool) return std::nullopt;

  std::optional<JointVector> home_all;
  if (home.node) {
    home_all.emplace(static_cast<Eigen::Index>(home.si.size()));
    std::ranges::copy(home.si, home_all->begin());
  }
  RobotModel model{name, convention, joints, frames, *tool, axis, home_all};
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
