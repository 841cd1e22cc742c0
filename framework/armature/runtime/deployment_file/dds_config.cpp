// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment_file/dds_config.hpp"

#include <fmt/format.h>

#include "armature/config/reader.hpp"
#include "armature/runtime/deployment_file/deployment_keys.hpp"

namespace armature {
namespace {

using config::Node;
using config::Problems;

std::vector<DdsConfig::Interface> read_interfaces(const Node& list, Problems& problems) {
  std::vector<DdsConfig::Interface> interfaces;
  if (list.kind() != Node::Kind::sequence) {
    problems.add(list.origin(), fmt::format("'interfaces' must be a list of names or IPv4 "
                                            "addresses, [eth0], not {}",
                                            list.describe()));
    return interfaces;
  }
  for (const Node& item : list.items()) {
    const auto name = config::to_text(item);
    if (!name) {
      problems.add(item.origin(), fmt::format("'interfaces' lists names or IPv4 addresses, not {}",
                                              item.describe()));
      continue;
    }
    const auto possible = check_interface_name(*name);
    if (!possible) problems.add(item.origin(), possible.error().text);
    interfaces.push_back({.name = *name, .origin = item.origin()});
  }
  return interfaces;
}

}  // namespace

std::vector<std::string> DdsConfig::interface_names() const {
  std::vector<std::string> names;
  for (const Interface& interface : interfaces) names.push_back(interface.name);
  return names;
}

DdsConfig read_dds(const Node* section, Problems& problems) {
  DdsConfig dds;
  if (!section) return dds;
  config::MapReader map{*section, "dds", dds_keys(), problems};
  if (const Node* list = map.node("interfaces")) {
    dds.interfaces = read_interfaces(*list, problems);
  }
  map.finish();
  return dds;
}

std::vector<NetworkInterface> find_interfaces(const DdsConfig& dds) {
  const std::vector<NetworkInterface> present = network_interfaces();
  Problems problems;
  for (const DdsConfig::Interface& interface : dds.interfaces) {
    const auto found = find_interfaces({interface.name}, present);
    if (!found) problems.add(interface.origin, found.error().text);
  }
  problems.throw_if_any();
  return find_interfaces(dds.interface_names(), present).value();
}

}  // namespace armature
