// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <stdexcept>
#include <string>

namespace armature {

/// A DDS domain that no other test uses at the same time, another one on every call; it is given
/// back when the process ends. Hand it to the programs that the test starts. Domains above 100 are
/// not used: their UDP ports lie where the kernel hands out its own.
inline int unique_dds_domain() {
  constexpr int kDomains = 100;
  const int first = static_cast<int>(getpid()) % kDomains;
  for (int i = 0; i < kDomains; ++i) {
    const int domain = 1 + (first + i) % kDomains;
    const std::string file = "/tmp/armature-test-domain-" + std::to_string(domain);
    const int fd = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (fd >= 0 && flock(fd, LOCK_EX | LOCK_NB) == 0) return domain;  // held until exit
    if (fd >= 0) close(fd);
  }
  throw std::runtime_error{"all test domains are in use: /tmp/armature-test-domain-*"};
}

}  // namespace armature
