// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/network.hpp"

#include <netdb.h>
#include <sys/socket.h>

#include <algorithm>
#include <charconv>
#include <memory>

namespace armature {
namespace {

/// The IPv4 address of a host, itself when it is one.
Expected<std::string> address_of(const std::string& host) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int failed = getaddrinfo(host.c_str(), nullptr, &hints, &found);
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner{found, [](addrinfo* list) {
                                                               if (list) freeaddrinfo(list);
                                                             }};
  if (failed) {
    return refuse("host '" + host +
                  "' has no IPv4 address that is known here: " + gai_strerror(failed));
  }
  char text[NI_MAXHOST];
  getnameinfo(found->ai_addr, found->ai_addrlen, text, sizeof text, nullptr, 0, NI_NUMERICHOST);
  return std::string{text};
}

/// The address of a host that can be reached as things are.
Expected<std::string> reachable_address(const std::string& host, const char* what,
                                        const std::vector<NetworkInterface>& joined) {
  auto address = address_of(host);
  if (!address || is_own_address(*address)) return address;
  const std::string who =
      std::string{what} + " " + host + (host == *address ? "" : " (" + *address + ")");
  const auto way = interface_towards(*address);
  if (!way) return refuse("no way leads to the " + who);
  if (std::ranges::find(joined, *way, &NetworkInterface::name) != joined.end()) return address;
  return refuse("the way to the " + who + " leads over interface '" + *way +
                "', which is not joined: name it, too");
}

}  // namespace

Expected<void> check_host_name(std::string_view text) {
  constexpr std::size_t kLongest = 253;  // RFC 1035
  const auto in_a_name = [](unsigned char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ||
           c == '.' || c == '_';
  };
  const std::string name{text};
  const bool numbers = !name.empty() && name.find_first_not_of("0123456789.") == std::string::npos;
  const bool is_name = !name.empty() && name.size() <= kLongest && name.front() != '.' &&
                       name.front() != '-' && std::ranges::all_of(name, in_a_name);
  if (numbers ? check_interface_name(name).has_value() : is_name) return {};
  return refuse("'" + name + "' is neither the name of a host nor an IPv4 address (192.168.7.2)");
}

Expected<ServerAddress> read_server_address(std::string_view text) {
  const std::size_t colon = text.find(':');
  ServerAddress server{.host = std::string{text.substr(0, colon)}, .port = kDiscoveryServerPort};
  if (const auto named = check_host_name(server.host); !named) {
    return refuse(named.error().text + "; a discovery server is host or host:port");
  }
  if (colon == std::string_view::npos) return server;
  const std::string_view port = text.substr(colon + 1);
  const auto [end, failed] = std::from_chars(port.data(), port.data() + port.size(), server.port);
  if (failed != std::errc{} || end != port.data() + port.size() || server.port == 0) {
    return refuse("'" + std::string{port} + "' in '" + std::string{text} +
                  "' is no port, from 1 to 65535");
  }
  return server;
}

Expected<Network> find_network(const NetworkOptions& options) {
  auto joined = find_interfaces(options.interfaces);
  if (!joined) return tl::unexpected{joined.error()};
  Network network{.joined = std::move(*joined)};
  for (const std::string& peer : options.peers) {
    auto address = reachable_address(peer, "peer", network.joined);
    if (!address) return tl::unexpected{address.error()};
    network.peers.push_back(std::move(*address));
  }
  if (options.discovery_server.empty()) return network;
  auto server = read_server_address(options.discovery_server);
  if (!server) return tl::unexpected{server.error()};
  auto address = reachable_address(server->host, "discovery server", network.joined);
  if (!address) return tl::unexpected{address.error()};
  network.server = ServerAddress{.host = std::move(*address), .port = server->port};
  return network;
}

std::string to_text(const Network& network) {
  std::string text = "lo";
  if (!network.joined.empty()) text += ", " + to_text(network.joined);
  if (network.server) {
    text += ", and finds others through the discovery server " + network.server->host + ":" +
            std::to_string(network.server->port);
  }
  std::string peers;
  for (const std::string& peer : network.peers) peers += (peers.empty() ? "" : ", ") + peer;
  if (!peers.empty()) text += ", and looks for others also at " + peers;
  return text;
}

}  // namespace armature
