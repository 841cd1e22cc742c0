// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "armature/bus/network_interface.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// How a process joins DDS, as a deployment file says it under `dds:`, or a tool's options. Alone:
/// on the loopback interface and through shared memory, with multicast to find others.
struct NetworkOptions {
  int domain = 0;
  /// Interfaces of this machine that are joined beside loopback, by name or IPv4 address.
  std::vector<std::string> interfaces = {};
  /// Hosts whose processes are also looked for without multicast, by name or IPv4 address.
  std::vector<std::string> peers = {};
  /// The discovery server of Fast DDS with id 0 that others are found through, "host:port"; empty:
  /// others are found without one.
  std::string discovery_server = {};
  /// False: over UDP only. Whoever is lost while it uses shared memory may hold a lock there, for
  /// which all that send to it wait.
  bool shared_memory = true;
};

struct ServerAddress {
  std::string host;  // a name, or an IPv4 address
  std::uint16_t port = 0;
};

/// The port of a discovery server when nothing says another.
inline constexpr std::uint16_t kDiscoveryServerPort = 11811;

/// Refuses a text that is no host name and no IPv4 address. Nobody is asked.
Expected<void> check_host_name(std::string_view text);
/// Reads "host" or "host:port". Nobody is asked.
Expected<ServerAddress> read_server_address(std::string_view text);

/// What the options mean on this machine, now.
struct Network {
  std::vector<NetworkInterface> joined;  // beside loopback
  std::vector<std::string> peers;        // IPv4 addresses
  std::optional<ServerAddress> server;   // its host an IPv4 address
};

/// Finds the interfaces, asks for the addresses of hosts (which may take seconds), and refuses what
/// is not there, and a host to which no joined interface leads.
Expected<Network> find_network(const NetworkOptions& options);

/// For people: "lo, eth0 (192.168.7.2), asks 192.168.7.3"
std::string to_text(const Network& network);

}  // namespace armature
