// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/joint_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "armature/robot/files/robot_keys.hpp"

namespace armature {
namespace {

using config::MapReader;
using config::Node;
using config::Problems;

/// A joint and where its coupling was written; the leader is looked up when all names are known.
struct ReadJoint {
  Joint joint;
  const Node* name = nullptr;
  const Node* leader = nullptr;
};

void read_limits(MapReader& map, Joint& joint, bool endless = false) {
  const bool revolute = joint.type == Joint::Type::revolute;
  const char* const key = revolute ? "limits_deg" : "limits_m";
  const auto limits = endless ? std::nullopt : map.optional_numbers(key);
  if (limits) {
    joint.lower = limits->front();
    joint.upper = limits->back();
    if (!(joint.lower < joint.upper)) {
      const Node& list = *map.node(key);
      map.problem(key,
                  fmt::format("'{}' is [lower, upper], and {} is not below {}", map.written(key),
                              list.items()[0].text(), list.items()[1].text()));
    }
  }
  const auto take = [&map](const char* speed, double& value) {
    value = map.optional_number(speed).value_or(value);
  };
  take(revolute ? "velocity_rad_s" : "velocity_m_s", joint.max_velocity);
  take(revolute ? "acceleration_rad_s2" : "acceleration_m_s2", joint.max_acceleration);
}

void read_drive(MapReader& map, Joint& joint) {
  const bool revolute = joint.type == Joint::Type::revolute;
  joint.locked = map.flag("locked");
  joint.drive_inertia = map.number(revolute ? "drive_inertia_kg_m2" : "drive_mass_kg");
  if (joint.locked && joint.coupling) {
    map.problem("locked", "a joint is coupled or locked, not both");
  }
  const char* const key = revolute ? "coupled_within_deg" : "coupled_within_m";
  const auto within = map.optional_number(key);
  if (within && !joint.coupling) {
    map.problem(key,
                fmt::format("'{}' is for a coupled joint, which '{}' is not", key, joint.name));
  }
  if (joint.coupling) joint.coupling->within = within;
}

/// The node that names the leader.
const Node* read_coupling(const Node& node, Joint& joint, Problems& problems) {
  const auto keys = coupling_keys(joint.type);
  MapReader map{node, "coupled", keys, problems};
  const Node* leader = map.node("to");
  const double ratio = map.optional_number("ratio").value_or(1);
  if (std::abs(ratio) < kMinRatio) {
    map.problem("ratio", fmt::format("'ratio' is {:g}, and must not be nearer to 0 than {:g}; a "
                                     "joint that does not move is a fixed angle",
                                     ratio, kMinRatio));
  }
  const double offset = map.number(joint.type == Joint::Type::revolute ? "offset_deg" : "offset_m");
  joint.coupling = {.to = 0, .ratio = ratio, .offset = offset};
  map.finish();
  return leader;
}

ReadJoint read_joint(const Node& node, Problems& problems) {
  const Node* name = node.find("name");
  const Node* type = node.find("type");
  ReadJoint result;
  Joint& joint = result.joint;
  if (type && type->text() == "prismatic") joint.type = Joint::Type::prismatic;
  auto keys = joint_keys(joint.type, node.find("coupled") != nullptr);
  const bool endless = type && type->text() == "continuous";
  if (endless) std::erase_if(keys, [](const auto& key) { return key.name == "limits_deg"; });
  MapReader map{node, name ? fmt::format("joint '{}'", name->text()) : "joint", keys, problems};
  joint.name = map.text("name");
  result.name = name;
  map.text("type");
  joint.theta = map.number("theta_deg");
  joint.d = map.number("d_m");
  joint.a = map.number("a_m");
  joint.alpha = map.number("alpha_deg");
  if (const Node* coupled = map.node("coupled")) {
    result.leader = read_coupling(*coupled, joint, problems);
  }
  read_limits(map, joint, endless);
  read_drive(map, joint);
  map.finish();
  return result;
}

void read_limits_of(const Node& node, std::vector<Joint>& joints, Problems& problems) {
  const Node* name = node.find("name");
  const auto joint = std::ranges::find(joints, name ? name->text() : "", &Joint::name);
  const bool is_known = joint != joints.end();
  const auto keys = urdf_joint_keys(is_known ? joint->type : Joint::Type::revolute);
  MapReader map{node, "joint", keys, problems};
  const std::string wanted = map.text("name");
  if (!is_known) {
    std::vector<std::string> names;
    for (const Joint& other : joints) names.push_back(other.name);
    if (wanted.empty()) return;
    map.problem("name", fmt::format("there is no joint '{}'{}", wanted,
                                    config::did_you_mean(wanted, names)));
    return;
  }
  const double before = joint->max_velocity;
  read_limits(map, *joint);
  const bool says = node.find("acceleration_rad_s2") || node.find("acceleration_m_s2");
  if (joint->max_velocity != before && !says)
    joint->max_acceleration = usual_acceleration(joint->max_velocity);
  read_drive(map, *joint);
  map.finish();
}

void told_twice(const Node& name, Problems& problems) {
  problems.add(name.origin(), fmt::format("there is a joint '{}' already", name.text()));
}

void check_names(const std::vector<ReadJoint>& joints, Problems& problems) {
  for (auto it = joints.begin(); it != joints.end(); ++it) {
    if (!it->name) continue;
    const std::string& name = it->joint.name;
    const auto same = [&](const ReadJoint& other) { return other.joint.name == name; };
    check_joint_name(name, it->name->origin(), problems);
    if (std::any_of(joints.begin(), it, same)) told_twice(*it->name, problems);
  }
}

void resolve_couplings(std::vector<ReadJoint>& joints, Problems& problems) {
  std::vector<std::string> names;
  for (const ReadJoint& other : joints) names.push_back(other.joint.name);
  for (ReadJoint& joint : joints) {
    if (!joint.leader) continue;
    const std::string& to = joint.leader->text();
    const auto found = std::ranges::find(names, to);
    if (found == names.end()) {
      problems.add(joint.leader->origin(),
                   fmt::format("there is no joint '{}'{}", to, config::did_you_mean(to, names)));
      continue;
    }
    const auto leader = found - names.begin();
    joint.joint.coupling->to = static_cast<int>(leader);
    if (joints[static_cast<std::size_t>(leader)].joint.coupling)
      problems.add(
          joint.leader->origin(),
          fmt::format("joint '{}' cannot follow '{}', which is coupled itself; name a joint that "
                      "moves by itself",
                      joint.joint.name, to));
  }
}

bool is_list(const Node& node, Problems& problems) {
  if (node.kind() == Node::Kind::sequence && !node.items().empty()) return true;
  problems.add(node.origin(),
               fmt::format("'joints' must be a list of joints, not {}",
                           node.kind() == Node::Kind::sequence ? "empty" : node.describe()));
  return false;
}

}  // namespace

std::vector<Joint> read_joints(const Node& list, Problems& problems) {
  if (!is_list(list, problems)) return {};
  if (list.items().size() > static_cast<std::size_t>(kMaxJoints))
    problems.add(list.origin(), fmt::format("{} joints are too many; a robot may have {}",
                                            list.items().size(), kMaxJoints));
  std::vector<ReadJoint> read;
  for (const Node& item : list.items()) read.push_back(read_joint(item, problems));
  check_names(read, problems);
  resolve_couplings(read, problems);

  std::vector<Joint> joints;
  for (ReadJoint& joint : read) joints.push_back(std::move(joint.joint));
  return joints;
}

void read_other_limits(const Node& list, std::vector<Joint>& joints, Problems& problems) {
  if (!is_list(list, problems)) return;
  std::set<std::string> named;
  for (const Node& item : list.items()) {
    read_limits_of(item, joints, problems);
    const Node* name = item.find("name");
    if (name && !named.insert(name->text()).second) told_twice(*name, problems);
  }
}

void check_joint_name(const std::string& name, const config::Origin& at, Problems& problems) {
  if (name == "base")
    problems.add(at, "a joint cannot be called 'base', which is the robot's foot");
}

double usual_acceleration(double max_velocity) { return max_velocity / 0.25; }

}  // namespace armature
