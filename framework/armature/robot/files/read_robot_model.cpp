// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "armature/config/document.hpp"
#include "armature/config/reader.hpp"
#include "armature/robot/files/body_reader.hpp"
#include "armature/robot/files/frame_reader.hpp"
#include "armature/robot/files/joint_reader.hpp"
#include "armature/robot/files/robot_keys.hpp"
#include "armature/robot/files/urdf_robot.hpp"
#include "armature/robot/model/robot_model.hpp"

namespace armature {
namespace {

using config::MapReader;
using config::Node;
using config::Problems;
using Eigen::Vector3d;

/// One of the words, or any direction.
std::optional<Vector3d> read_axis(MapReader& map, std::string_view key) {
  const Node* node = map.node(key);
  if (!node) return std::nullopt;
  if (node->kind() == Node::Kind::sequence) {
    const auto axis = config::to_numbers(*node, 3);
    if (!axis) {
      map.problem(key, fmt::format("'{}' {}", key, axis.error().message));
      return std::nullopt;
    }
    const Vector3d direction{(*axis)[0], (*axis)[1], (*axis)[2]};
    if (direction.norm() > 1e-6) return direction.normalized();
    map.problem(key, fmt::format("'{}' has no length", key));
    return std::nullopt;
  }
  const auto word = std::ranges::find(axis_words(), node->text());
  if (word != axis_words().end()) {
    const auto axis = word - axis_words().begin();
    return Vector3d{(axis < 3 ? 1 : -1) * Vector3d::Unit(axis % 3)};
  }
  map.problem(key, fmt::format("'{}' must be {} or a list of 3 numbers, not {}", key,
                               fmt::join(axis_words(), ", "), node->describe()));
  return std::nullopt;
}

std::optional<Shaft> read_shaft(MapReader& robot, Problems& problems) {
  const Node* node = robot.node("shaft");
  if (!node) return std::nullopt;
  MapReader map{*node, "shaft", shaft_keys(), problems};
  const auto axis = read_axis(map, "axis");
  const double length = map.number("length_m");
  map.finish();
  if (!axis) return std::nullopt;
  return Shaft{.axis = *axis, .length = length};
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

/// The home position of all joints; nothing when none is written or it is wrong.
std::optional<std::vector<double>> read_home(MapReader& map, const std::vector<Joint>& joints) {
  auto home = map.optional_numbers("home_deg");
  if (!home || joints.empty()) return std::nullopt;
  const std::string key = map.written("home_deg");
  const auto prismatic = std::ranges::find(joints, Joint::Type::prismatic, &Joint::type);
  if (key == "home_deg" && prismatic != joints.end())
    map.problem("home_deg", fmt::format("'home_deg' cannot state the prismatic joint '{}'; write "
                                        "'home' in radians and metres",
                                        prismatic->name));
  if (home->size() == joints.size()) return home;
  map.problem("home_deg", fmt::format("'{}' needs a value for each of the {} joints, not {}", key,
                                      joints.size(), home->size()));
  return std::nullopt;
}

/// In what a user's file says: degrees or metres.
std::string in_file_units(double value, bool revolute) {
  return revolute ? fmt::format("{:.10g} deg", value * 180 / std::numbers::pi)
                  : fmt::format("{:.10g} m", value);
}

/// "'home_deg': j1 = 200 deg is outside of -170 deg to 170 deg".
std::string outside(MapReader& map, const Joint& joint, double q, double lower, double upper) {
  const bool revolute = joint.type == Joint::Type::revolute;
  return fmt::format("'{}': {} = {} is outside of {} to {}", map.written("home_deg"), joint.name,
                     in_file_units(q, revolute), in_file_units(lower, revolute),
                     in_file_units(upper, revolute));
}

/// What only shows when all joints are together: couplings that leave no room, a home out of reach.
void check_whole(const RobotModel& model, MapReader& map) {
  for (int i = 0; i < model.dof(); ++i)
    if (!(model.lower()[i] < model.upper()[i]))
      map.problem(
          "joints",
          fmt::format("joint '{}' has no room to move: its limits and those of the joints "
                      "that follow it exclude each other",
                      model.joints()[static_cast<std::size_t>(model.independent_joint(i))].name));
  if (!model.home()) return;
  constexpr double kLastBits = 1e-9;  // of a limit that a coupled joint sets
  const std::string home = map.written("home_deg");
  const auto independent = model.to_independent(*model.home());
  if (!independent) {
    map.problem("home_deg", fmt::format("'{}': {}", home, independent.error().text));
    return;
  }
  for (int i = 0; i < model.dof(); ++i) {
    const double q = (*independent)[i];
    if (q >= model.lower()[i] - kLastBits && q <= model.upper()[i] + kLastBits) continue;
    const auto& joint = model.joints()[static_cast<std::size_t>(model.independent_joint(i))];
    map.problem("home_deg", outside(map, joint, q, model.lower()[i], model.upper()[i]));
  }
}

/// From the rows in the file itself; the tool's frame.
std::optional<FrameId> read_rows(MapReader& map, RobotParts& parts, ParentNames& parents,
                                 Problems& problems) {
  const bool modified = map.text("convention") == "modified";
  parts.convention = modified ? RobotModel::Convention::modified : RobotModel::Convention::standard;
  if (const Node* list = map.node("joints")) parts.joints = read_joints(*list, problems);
  parents.joints = parts.joints;
  parents.is_unread = parts.joints.empty();
  if (const Node* frames = map.node("frames"))
    parts.frames = read_frames(*frames, parents, problems);
  parents.frames = parts.frames;
  return find_tool(map, parts.frames, parts.joints);
}

/// Motion needs every joint's speed; URDF may leave a continuous joint's open.
void check_speeds(const std::vector<Joint>& joints, MapReader& map) {
  for (const Joint& joint : joints) {
    if (joint.coupling || joint.locked || std::isfinite(joint.max_velocity)) continue;
    const bool slides = joint.type == Joint::Type::prismatic;
    map.problem("urdf", fmt::format("joint '{0}' has no velocity limit; state it in the URDF file, "
                                    "or here: joints: [{{name: {0}, {1}: 1}}]",
                                    joint.name, slides ? "velocity_m_s" : "velocity_rad_s"));
  }
}

/// From a URDF file; its frames are the links from base to tip, 'tool', and what the robot file
/// adds.
std::optional<FrameId> read_urdf(const Node& file, MapReader& map, RobotParts& parts,
                                 ParentNames& parents, Problems& problems) {
  const auto link = [](const Node* node, const Node& otherwise) {
    return node ? LinkName{node->text(), node->origin()} : LinkName{"", otherwise.origin()};
  };
  const LinkName base = link(map.node("base"), file);
  const LinkName tip = link(map.node("tip"), file);
  const Node* limits = map.node("joints");
  const Node* more = map.node("frames");
  parts.convention = RobotModel::Convention::modified;
  parents.is_unread = true;
  if (tip.name.empty()) return std::nullopt;  // noted as missing
  UrdfArm arm = read_urdf_arm(config::folder_of(file.origin()) / file.text(), file.origin(), base,
                              tip, problems);
  parts.joints = arm.joints;
  parts.frames = std::move(arm.frames);
  if (arm.tool && !(more && more->find("tool"))) parts.frames.push_back(*arm.tool);
  if (parts.joints.empty()) return arm.tip;
  parents = {
      .joints = {}, .frames = parts.frames, .is_urdf = true, .no_frames = std::move(arm.no_frames)};
  if (limits) read_other_limits(*limits, parts.joints, problems);
  check_urdf_limits(arm, parts.joints, problems);
  check_speeds(parts.joints, map);
  if (!more) return arm.tip;
  const auto added = read_frames(*more, parents, problems);
  const std::size_t first = parts.frames.size();
  parts.frames.insert(parts.frames.end(), added.begin(), added.end());
  parents.frames = parts.frames;
  const auto tool = std::ranges::find(added, "tool", &NamedFrame::name);
  if (tool == added.end()) return arm.tip;
  return FrameId{static_cast<int>(first + static_cast<std::size_t>(tool - added.begin()))};
}

void check_locked(const RobotParts& parts, MapReader& map) {
  for (std::size_t i = 0; i < parts.joints.size(); ++i) {
    const Joint& joint = parts.joints[i];
    if (joint.coupling) {
      const Joint& leader = parts.joints[static_cast<std::size_t>(joint.coupling->to)];
      if (leader.locked) {
        map.problem("joints", fmt::format("joint '{}' follows '{}', which is locked", joint.name,
                                          leader.name));
      }
    }
    if (!joint.locked) continue;
    if (!parts.home) {
      map.problem("joints", fmt::format("joint '{}' is locked where it is at home, and the file "
                                        "has none; add home_deg: or home:",
                                        joint.name));
      continue;
    }
    const double q = (*parts.home)[static_cast<Eigen::Index>(i)];
    if (q < joint.lower || q > joint.upper)
      map.problem("home_deg", outside(map, joint, q, joint.lower, joint.upper));
  }
  const bool all_locked =
      !parts.joints.empty() && std::ranges::all_of(parts.joints, &Joint::locked);
  if (all_locked) map.problem("joints", "every joint is locked; leave one that moves");
}

std::optional<RobotModel> read(const Node& document, Problems& problems) {
  const bool is_urdf = document.find("urdf") != nullptr;
  MapReader map{document, "robot", is_urdf ? urdf_robot_keys() : robot_keys(), problems};
  const Node* urdf = map.node("urdf");
  map.integer("armature_robot");
  RobotParts parts;
  parts.name = map.text("name");
  ParentNames parents;
  const std::optional<FrameId> tool = urdf ? read_urdf(*urdf, map, parts, parents, problems)
                                           : read_rows(map, parts, parents, problems);
  parts.pointing_axis = read_axis(map, "pointing_axis");
  parts.shaft = read_shaft(map, problems);
  if (const Node* capsules = map.node("capsules")) {
    parts.capsules = read_capsules(*capsules, parents, problems);
  }
  if (const Node* masses = map.node("masses")) {
    parts.masses = read_masses(*masses, parents, problems);
  }
  if (const auto home = read_home(map, parts.joints)) {
    parts.home.emplace(
        Eigen::Map<const Eigen::VectorXd>{home->data(), static_cast<Eigen::Index>(home->size())});
  }
  check_locked(parts, map);
  map.finish();
  if (!problems.empty() || !tool) return std::nullopt;
  parts.tool = *tool;
  RobotModel model{std::move(parts)};
  check_whole(model, map);
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
