// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "armature/bus/network_interface.hpp"
#include "armature/config/node.hpp"
#include "armature/config/problems.hpp"

namespace armature ARMATURE_EXPORT {

/// `dds:` of a deployment file: how its processes join DDS.
struct DdsConfig {
  /// A name or an IPv4 address, as the file says it.
  struct Interface {
    std::string name;
    config::Origin origin;
  };
  std::vector<Interface> interfaces;  // joined beside loopback

  std::vector<std::string> interface_names() const;
};

/// Reads `dds: {interfaces: [eth0, 192.168.7.2]}`. Whether the machine has them is not asked: a
/// file is also checked on other machines. `section` may be null: loopback only.
DdsConfig read_dds(const config::Node* section, config::Problems& problems);

/// The interfaces of this machine that `dds` names. Throws ConfigError with all that cannot be
/// joined.
std::vector<NetworkInterface> find_interfaces(const DdsConfig& dds);

}  // namespace armature
