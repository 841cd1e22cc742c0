// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/body_reader.hpp"

#include <fmt/format.h>

#include "armature/robot/files/robot_keys.hpp"
#include "armature/robot/files/written_pose.hpp"

namespace armature {
namespace {

using config::MapReader;
using config::Node;
using config::Problems;
using Eigen::Vector3d;

Parent find_parent(const Node& named, const ParentNames& parents, Problems& problems) {
  const auto found = parents.find(named.text());
  if (!found) parents.refuse(named, {}, problems);
  return found.value_or(Parent{});
}

/// The name of a section of bodies, and the word for one of them.
struct Words {
  const char *section, *one;
};

/// Reads what is named in `map`: `read(name, entry, parent)` each.
template <class Read>
void read_named(const Node& map, const Words& words, const std::vector<config::KeySpec>& keys,
                const ParentNames& parents, Problems& problems, Read read) {
  if (map.kind() != Node::Kind::map) {
    return problems.add(map.origin(), fmt::format("'{0}' must be a map of {0}, not {1}",
                                                  words.section, map.describe()));
  }
  for (const Node::Entry& entry : map.entries()) {
    MapReader reader{entry.value, fmt::format("{} '{}'", words.one, entry.key), keys, problems};
    const Node* named = reader.node("parent");
    read(entry.key, reader, named ? find_parent(*named, parents, problems) : Parent{});
    reader.finish();
  }
}

}  // namespace

std::vector<LinkCapsule> read_capsules(const Node& map, const ParentNames& parents,
                                       Problems& problems) {
  std::vector<LinkCapsule> capsules;
  read_named(map, {"capsules", "capsule"}, capsule_keys(), parents, problems,
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

std::vector<LinkMass> read_masses(const Node& map, const ParentNames& parents, Problems& problems) {
  std::vector<LinkMass> masses;
  read_named(map, {"masses", "mass"}, mass_keys(), parents, problems,
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
