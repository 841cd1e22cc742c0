// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/joint_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "armature/robot/files/quantity_reader.hpp"

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

void read_positive(MapReader& map, std::string_view key, bool required, double& value,
                   Problems& problems) {
  const Quantity quantity =
      required ? require_quantity(map, {key}, 1, problems) : read_quantity(map, {key}, 1, problems);
  if (!quantity.number()) return;
  value = *quantity.number();
  if (!(value > 0)) map.problem(key, fmt::format("'{}' must be more than 0, not {}", key, value));
}

void read_limits(MapReader& map, bool required, Joint& joint, Problems& problems) {
  const bool revolute = joint.type == Joint::Type::revolute;
  const auto read = required ? require_quantity : read_quantity;
  const Quantity limits = revolute ? read(map, {"limits_deg"}, 2, problems)
                                   : read(map, {"limits_m", "limits_mm"}, 2, problems);
  if (limits.si.size() == 2) {
    joint.lower = limits.si[0];
    joint.upper = limits.si[1];
    if (!(joint.lower < joint.upper))
      map.problem(limits.key,
                  fmt::format("'{}' is [lower, upper], and {} is not below {}", limits.key,
                              limits.node->items()[0].text(), limits.node->items()[1].text()));
  }
  read_positive(map, revolute ? "velocity_rad_s" : "velocity_m_s", required, joint.max_velocity,
                problems);
  read_positive(map, revolute ? "acceleration_rad_s2" : "acceleration_m_s2", required,
                joint.max_acceleration, problems);
}

const Node* read_coupling(MapReader& map, Joint& joint, Problems& problems) {
  const Node* node = map.optional_node("coupled");
  if (!node) return nullptr;
  joint.coupling.emplace();
  MapReader coupled{*node, "coupled", problems};
  const Node* leader = coupled.node("to");
  if (const auto ratio = read_quantity(coupled, {"ratio"}, 1, problems).number()) {
    joint.coupling->ratio = *ratio;
    if (*ratio == 0)
      coupled.problem("ratio",
                      "'ratio' must not be 0; a joint that does not move is a fixed angle");
  }
  const Quantity offset = joint.type == Joint::Type::revolute
                              ? read_quantity(coupled, {"offset_deg"}, 1, problems)
                              : read_quantity(coupled, {"offset_m", "offset_mm"}, 1, problems);
  joint.coupling->offset = offset.number().value_or(0);
  coupled.finish();
  return leader;
}

ReadJoint read_joint(const Node& node, Problems& problems) {
  const Node* name = node.find("name");
  MapReader map{node, name ? fmt::format("joint '{}'", name->text()) : "joint", problems};
  ReadJoint result;
  Joint& joint = result.joint;
  joint.name = map.text("name");
  result.name = name;
  if (map.choice("type", {"revolute", "prismatic"}, "revolute") == "prismatic")
    joint.type = Joint::Type::prismatic;
  joint.theta = read_quantity(map, {"theta_deg"}, 1, problems).number().value_or(0);
  joint.d = read_quantity(map, {"d_m", "d_mm"}, 1, problems).number().value_or(0);
  joint.a = read_quantity(map, {"a_m", "a_mm"}, 1, problems).number().value_or(0);
  joint.alpha = read_quantity(map, {"alpha_deg"}, 1, problems).number().value_or(0);
  result.leader = read_coupling(map, joint, problems);
  read_limits(map, !joint.coupling, joint, problems);  // a leader's limits may do
  map.finish();
  return result;
}

void read_limits_of(const Node& node, std::vector<Joint>& joints, Problems& problems) {
  MapReader map{node, "joint", problems};
  const std::string name = map.text("name");
  const auto joint = std::ranges::find(joints, name, &Joint::name);
  if (joint == joints.end()) {
    std::vector<std::string> names;
    for (const Joint& other : joints) names.push_back(other.name);
    if (!name.empty())
      map.problem("name",
                  fmt::format("there is no joint '{}'{}", name, config::did_you_mean(name, names)));
    return;
  }
  const double before = joint->max_velocity;
  read_limits(map, false, *joint, problems);
  const bool says = node.find("acceleration_rad_s2") || node.find("acceleration_m_s2");
  if (joint->max_velocity != before && !says)
    joint->max_acceleration = usual_acceleration(joint->max_velocity);
  map.finish();
}

void check_names(const std::vector<ReadJoint>& joints, Problems& problems) {
  for (auto it = joints.begin(); it != joints.end(); ++it) {
    if (!it->name) continue;
    const std::string& name = it->joint.name;
    const auto same = [&](const ReadJoint& other) { return other.joint.name == name; };
    check_joint_name(name, it->name->origin(), problems);
    if (std::any_of(joints.begin(), it, same))
      problems.add(it->name->origin(), fmt::format("there is a joint '{}' already", name));
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
  for (const Node& item : list.items()) read_limits_of(item, joints, problems);
}

void check_joint_name(const std::string& name, const config::Origin& at, Problems& problems) {
  if (name == "base")
    problems.add(at, "a joint cannot be called 'base', which is the robot's foot");
}

double usual_acceleration(double max_velocity) { return max_velocity / 0.25; }

}  // namespace armature
