// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// A network interface of this machine, as far as DDS over IPv4 needs to know it.
struct NetworkInterface {
  std::string name;                    // "eth0"
  std::vector<std::string> addresses;  // IPv4: "192.168.7.2"
  bool up = false;                     // switched on
  bool has_link = false;               // to another machine, or to itself
};

/// Those of this machine; none when the system does not tell.
std::vector<NetworkInterface> network_interfaces();

/// Refuses a text that names no interface and is no IPv4 address, on whatever machine.
Expected<void> check_interface_name(std::string_view text);

/// What `wanted` (names, or IPv4 addresses) means of `present`, each interface once: a name all of
/// its addresses, an address that one only. Loopback (127.*) is no part of it, since DDS joins that
/// always. Refuses what is absent, down, without a link or without an address, with those that can
/// be joined.
Expected<std::vector<NetworkInterface>> find_interfaces(
    const std::vector<std::string>& wanted,
    const std::vector<NetworkInterface>& present = network_interfaces());

/// "eth0 (192.168.7.2), eth1 (10.0.0.5)"
std::string to_text(const std::vector<NetworkInterface>& interfaces);

/// Whether an IPv4 address is one of this machine's: a loopback one, or that of an interface.
bool is_own_address(const std::string& address);

/// The interface over which this machine sends to an IPv4 address; nothing when no way leads there.
std::optional<std::string> interface_towards(const std::string& address);

}  // namespace armature
