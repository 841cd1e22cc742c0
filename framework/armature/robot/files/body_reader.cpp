// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/body_reader.hpp"

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

/// The joint that a body hangs on, -1 for the base, and where on it.
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

/// The name of a section of bodies, and the word for one of them.
struct Words {
  const char *section, *one;
};

/// Reads what is named in `map`: `read(name, entry, parent)` each.
template <class Read>
void read_named(const Node& map, const Words& words, const std::vector<config::KeySpec>& keys,
                const std::vector<Joint>& joints, const std::vector<NamedFrame>& frames,
                Problems& problems, Read read) {
  if (map.kind() != Node::Kind::map) {
    return problems.add(map.origin(), fmt::format("'{0}' must be a map of {0}, not {1}",
                                                  words.section, map.describe()));
  }
  for (const Node::Entry& entry : map.entries()) {
    MapReader reader{entry.value, fmt::format("{} '{}'", words.one, entry.key), keys, problems};
    const Node* named = reader.node("parent");
    read(entry.key, reader, named ? find_parent(*named, joints, frames, problems) : Parent{});
    reader.finish();
  }
}

}  // namespace

std::vector<LinkCapsule> read_capsules(const Node& map, const std::vector<Joint>& joints,
                                       const std::vector<NamedFrame>& frames, Problems& problems) {
  std::vector<LinkCapsule> capsules;
  read_named(map, {"capsules", "capsule"}, capsule_keys(), joints, frames, problems,
             [&](const std::string& name, MapReader& reader, const Parent& parent) {
               const auto from = read_vector(reader, "from_m").value_or(Vector3d::Zero());
               const auto to = read_vector(reader, "to_m").value_or(Vector3d::Zero());
               capsules.push_back({.name = name,
                                   .parent_joint = parent.joint,
                                   .from = parent.joint_T_parent * from,
                                   .to = parent.joint_T_parent * to,
                                   .radius = reader.number("radius_m")});
             });
  return capsules;
}

std::vector<LinkMass> read_masses(const Node& map, const std::vector<Joint>& joints,
                                  const std::vector<NamedFrame>& frames, Problems& problems) {
  std::vector<LinkMass> masses;
  read_named(map, {"masses", "mass"}, mass_keys(), joints, frames, problems,
             [&](const std::string& name, MapReader& reader, const Parent& parent) {
               const auto centre = read_vector(reader, "centre_m").value_or(Vector3d::Zero());
               masses.push_back({.name = name,
                                 .parent_joint = parent.joint,
                                 .centre = parent.joint_T_parent * centre,
                                 .mass = reader.number("mass_kg")});
             });
  return masses;
}

}  // namespace armature
