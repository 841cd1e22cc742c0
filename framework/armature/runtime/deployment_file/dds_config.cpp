// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment_file/dds_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>

#include "armature/config/reader.hpp"
#include "armature/runtime/deployment_file/deployment_keys.hpp"

namespace armature {
namespace {

using config::Node;
using config::Problems;

using Check = std::function<Expected<void>(const std::string&)>;

std::vector<DdsConfig::Named> read_list(const char* key, const char* example, const Node& list,
                                        const Check& check, Problems& problems) {
  std::vector<DdsConfig::Named> all;
  if (list.kind() != Node::Kind::sequence) {
    problems.add(list.origin(),
                 fmt::format("'{}' must be a list of names or IPv4 addresses, [{}], not {}", key,
                             example, list.describe()));
    return all;
  }
  for (const Node& item : list.items()) {
    const auto name = config::to_text(item);
    if (!name) {
      problems.add(item.origin(),
                   fmt::format("'{}' lists names or IPv4 addresses, not {}", key, item.describe()));
      continue;
    }
    const auto possible = check(*name);
    if (!possible) problems.add(item.origin(), possible.error().text);
    all.push_back({.name = *name, .origin = item.origin()});
  }
  return all;
}

std::vector<std::string> names_of(const std::vector<DdsConfig::Named>& all) {
  std::vector<std::string> names;
  std::ranges::transform(all, std::back_inserter(names), &DdsConfig::Named::name);
  return names;
}

}  // namespace

NetworkOptions DdsConfig::network(int domain) const {
  return {.domain = domain,
          .interfaces = names_of(interfaces),
          .peers = names_of(peers),
          .discovery_server = discovery_server ? discovery_server->name : "",
          .shared_memory = shared_memory};
}

DdsConfig read_dds(const Node* section, Problems& problems) {
  DdsConfig dds;
  if (!section) return dds;
  config::MapReader map{*section, "dds", dds_keys(), problems};
  if (const Node* list = map.node("interfaces")) {
    dds.interfaces = read_list("interfaces", "eth0", *list, check_interface_name, problems);
  }
  if (const Node* list = map.node("peers")) {
    dds.peers = read_list("peers", "theatre-2", *list, check_host_name, problems);
  }
  if (const Node* server = map.node("discovery_server")) {
    dds.discovery_server = {.name = map.text("discovery_server"), .origin = server->origin()};
    const auto possible = read_server_address(dds.discovery_server->name);
    if (!possible) problems.add(server->origin(), possible.error().text);
    if (!dds.peers.empty()) {
      problems.add(server->origin(),
                   "'peers' are asked without a discovery server; the file names both");
    }
  }
  dds.shared_memory = map.text("shared_memory") == "on";
  map.finish();
  return dds;
}

Network find_network(const DdsConfig& dds) {
  Problems problems;
  const auto find = [&](const config::Origin& origin, const NetworkOptions& part) {
    const auto found = armature::find_network(part);
    if (!found) problems.add(origin, found.error().text);
  };
  for (const auto& [name, origin] : dds.interfaces) find(origin, {.interfaces = {name}});
  problems.throw_if_any();  // without them no way leads to the others
  const std::vector<std::string> joined = names_of(dds.interfaces);
  for (const auto& [name, origin] : dds.peers) {
    find(origin, {.interfaces = joined, .peers = {name}});
  }
  if (const auto& server = dds.discovery_server) {
    find(server->origin, {.interfaces = joined, .discovery_server = server->name});
  }
  problems.throw_if_any();
  return armature::find_network(dds.network(0)).value();
}

}  // namespace armature
