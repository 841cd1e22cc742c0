// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "armature/bus/network.hpp"
#include "armature/config/node.hpp"
#include "armature/config/problems.hpp"

namespace armature ARMATURE_EXPORT {

/// `dds:` of a deployment file: how its processes join DDS.
struct DdsConfig {
  /// A name or an address, as the file says it.
  struct Named {
    std::string name;
    config::Origin origin;
  };
  std::vector<Named> interfaces;  // joined beside loopback
  std::vector<Named> peers;
  std::optional<Named> discovery_server;
  bool shared_memory = true;

  NetworkOptions network(int domain) const;
};

/// Reads `dds: {interfaces: [eth0], peers: [desk], ...}`. Whether there are such is not asked: a
/// file is also checked on other machines. `section` may be null: loopback only.
DdsConfig read_dds(const config::Node* section, config::Problems& problems);

/// What `dds` means on this machine. Throws ConfigError with all that cannot be joined or reached.
Network find_network(const DdsConfig& dds);

}  // namespace armature
