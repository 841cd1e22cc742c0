// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/network_interface.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <memory>

namespace armature {
namespace {

std::string text_of(const in_addr& address) {
  char text[INET_ADDRSTRLEN];
  return inet_ntop(AF_INET, &address, text, sizeof text);
}

bool is_ipv4(const std::string& text) {
  in_addr address{};
  return inet_pton(AF_INET, text.c_str(), &address) == 1;
}

bool is_ipv6(const std::string& text) {
  in6_addr address{};
  const std::string without_scope = text.substr(0, text.find('%'));
  return inet_pton(AF_INET6, without_scope.c_str(), &address) == 1;
}

bool is_loopback(const std::string& address) { return address.starts_with("127."); }

bool has_address(const NetworkInterface& interface, const std::string& address) {
  return std::ranges::find(interface.addresses, address) != interface.addresses.end();
}

/// Fast DDS passes over an interface that has no link.
bool can_be_joined(const NetworkInterface& interface) {
  return interface.up && interface.has_link && !interface.addresses.empty();
}

std::string what_can_be_joined(const std::vector<NetworkInterface>& present) {
  std::vector<NetworkInterface> all;
  std::ranges::copy_if(present, std::back_inserter(all),
                       [](const auto& interface) { return can_be_joined(interface); });
  return all.empty() ? "this machine has none with an IPv4 address that is up"
                     : "this machine has " + to_text(all);
}

/// What of `present` a text means, or why it cannot be joined.
Expected<NetworkInterface> find_interface(const std::string& text,
                                          const std::vector<NetworkInterface>& present) {
  if (const auto named = check_interface_name(text); !named) return tl::unexpected{named.error()};
  const bool by_address = is_ipv4(text);
  const auto found = std::ranges::find_if(present, [&](const NetworkInterface& interface) {
    return by_address ? has_address(interface, text) : interface.name == text;
  });
  const auto refused = [&](const std::string& why) {
    return refuse(why + "; " + what_can_be_joined(present));
  };
  if (found == present.end()) {
    return refused(by_address ? "no interface has the address " + text
                              : "there is no interface '" + text + "'");
  }
  const std::string which =
      "interface '" + found->name + "'" + (by_address ? ", which has " + text + "," : "");
  if (!found->up) return refused(which + " is down ('ip link set dev " + found->name + " up')");
  if (!found->has_link) return refused(which + " has no link (is its cable plugged in?)");
  if (found->addresses.empty()) {
    return refused(which + " has no IPv4 address, which DDS joins by");
  }
  NetworkInterface meant = *found;
  if (by_address) meant.addresses = {text};
  return meant;
}

}  // namespace

std::vector<NetworkInterface> network_interfaces() {
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return {};
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owner{list, &freeifaddrs};
  std::vector<NetworkInterface> all;
  for (const ifaddrs* one = list; one; one = one->ifa_next) {
    auto known = std::ranges::find(all, one->ifa_name, &NetworkInterface::name);
    if (known == all.end()) {
      known = all.insert(known, {.name = one->ifa_name,
                                 .up = (one->ifa_flags & IFF_UP) != 0,
                                 .has_link = (one->ifa_flags & IFF_RUNNING) != 0});
    }
    if (!one->ifa_addr || one->ifa_addr->sa_family != AF_INET) continue;
    known->addresses.push_back(
        text_of(reinterpret_cast<const sockaddr_in*>(one->ifa_addr)->sin_addr));
  }
  return all;
}

Expected<void> check_interface_name(std::string_view text) {
  const std::string name{text};
  if (name.empty()) return refuse("an interface has a name, or an IPv4 address");
  if (is_ipv4(name)) return {};
  if (is_ipv6(name)) {
    return refuse("'" + name + "' is an IPv6 address, and DDS joins IPv4 only; give its interface");
  }
  const bool numbers = name.find_first_not_of("0123456789.") == std::string::npos;
  const bool possible = name.size() < IFNAMSIZ && name.find_first_of("/ \t\n") == std::string::npos;
  if (numbers || !possible) {
    return refuse("'" + name + "' is neither the name of an interface (at most " +
                  std::to_string(IFNAMSIZ - 1) + " characters) nor an IPv4 address (192.168.7.2)");
  }
  return {};
}

Expected<std::vector<NetworkInterface>> find_interfaces(
    const std::vector<std::string>& wanted, const std::vector<NetworkInterface>& present) {
  std::vector<NetworkInterface> all;
  for (const std::string& text : wanted) {
    const auto found = find_interface(text, present);
    if (!found) return tl::unexpected{found.error()};
    for (const std::string& address : found->addresses) {
      if (is_loopback(address)) continue;
      auto known = std::ranges::find(all, found->name, &NetworkInterface::name);
      if (known == all.end()) {
        known = all.insert(known, *found);
        known->addresses.clear();
      }
      if (!has_address(*known, address)) known->addresses.push_back(address);
    }
  }
  return all;
}

std::string to_text(const std::vector<NetworkInterface>& interfaces) {
  std::string text;
  for (const NetworkInterface& interface : interfaces) {
    std::string addresses;
    for (const std::string& address : interface.addresses) {
      addresses += (addresses.empty() ? "" : ", ") + address;
    }
    text += (text.empty() ? "" : ", ") + interface.name + " (" + addresses + ")";
  }
  return text;
}

bool is_own_address(const std::string& address) {
  return is_loopback(address) || std::ranges::any_of(network_interfaces(), [&](const auto& one) {
           return has_address(one, address);
         });
}

std::optional<std::string> interface_towards(const std::string& address) {
  sockaddr_in there{}, here{};
  there.sin_family = AF_INET;
  there.sin_port = htons(7400);  // any: nothing is sent
  if (inet_pton(AF_INET, address.c_str(), &there.sin_addr) != 1) return std::nullopt;
  const int asks = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  socklen_t size = sizeof here;
  const bool known = connect(asks, reinterpret_cast<const sockaddr*>(&there), sizeof there) == 0 &&
                     getsockname(asks, reinterpret_cast<sockaddr*>(&here), &size) == 0;
  if (asks >= 0) close(asks);
  if (!known) return std::nullopt;
  const std::vector<NetworkInterface> all = network_interfaces();
  const auto found = std::ranges::find_if(
      all, [&](const auto& one) { return has_address(one, text_of(here.sin_addr)); });
  return found == all.end() ? std::nullopt : std::optional{found->name};
}

}  // namespace armature
