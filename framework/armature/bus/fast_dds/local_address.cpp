// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/fast_dds/local_address.hpp"

#include <ifaddrs.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstring>
#include <memory>

namespace armature {

bool is_local_address(const std::array<std::uint8_t, 4>& address) {
  if (address[0] == 127) return true;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return false;
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> all{list, &freeifaddrs};
  for (const ifaddrs* one = list; one; one = one->ifa_next) {
    if (!one->ifa_addr || one->ifa_addr->sa_family != AF_INET) continue;
    const auto& own = reinterpret_cast<const sockaddr_in*>(one->ifa_addr)->sin_addr;
    if (std::memcmp(&own, address.data(), address.size()) == 0) return true;
  }
  return false;
}

}  // namespace armature
