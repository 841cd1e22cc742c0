// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/capsule_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "armature/robot/files/robot_keys.hpp"
#include "armature/robot/files/written_pose.hpp"

namespace armature {
namespace {

using config::MapReader;
using config::Node;
using config::Problems;
using Eigen::Vector3d;

/// What a capsule hangs on.
struct Parent {
  int joint = -1;
  Eigen::Isometry3d joint_T_parent = Eigen::Isometry3d::Identity();
};

Parent find_parent(const Node& named, const std::vector<Joint>& joints,
                   const std::vector<NamedFrame>& frames, Problems& problems) {
  const std::string& name = named.text();
  if (name == "base") return {};
  const auto joint = std::ranges::find(joints, name, &Joint::name);
  if (joint != joints.end()) return {.joint = static_cast<int>(joint - joints.begin())};
  const auto frame = std::ranges::find(frames, name, &NamedFrame::name);
  if (frame != frames.end()) return {frame->parent_joint, frame->parent_T_frame};
  std::vector<std::string> known{"base"};
  for (const Joint& each : joints) known.push_back(each.name);
  for (const NamedFrame& each : frames) known.push_back(each.name);
  problems.add(named.origin(), fmt::format("there is no joint or frame '{}'{}", name,
                                           config::did_you_mean(name, known)));
  return {};
}

}  // namespace

std::vector<LinkCapsule> read_capsules(const Node& map, const std::vector<Joint>& joints,
                                       const std::vector<NamedFrame>& frames, Problems& problems) {
  if (map.kind() != Node::Kind::map) {
    problems.add(map.origin(),
                 fmt::format("'capsules' must be a map of capsules, not {}", map.describe()));
    return {};
  }
  std::vector<LinkCapsule> capsules;
  for (const Node::Entry& entry : map.entries()) {
    MapReader reader{entry.value, fmt::format("capsule '{}'", entry.key), capsule_keys(), problems};
    const Node* named = reader.node("parent");
    const Parent parent = named ? find_parent(*named, joints, frames, problems) : Parent{};
    const Vector3d from = read_vector(reader, "from_m").value_or(Vector3d::Zero());
    const Vector3d to = read_vector(reader, "to_m").value_or(Vector3d::Zero());
    const double radius = reader.number("radius_m");
    reader.finish();
    capsules.push_back({.name = entry.key,
                        .parent_joint = parent.joint,
                        .from = parent.joint_T_parent * from,
                        .to = parent.joint_T_parent * to,
                        .radius = radius});
  }
  return capsules;
}

}  // namespace armature
