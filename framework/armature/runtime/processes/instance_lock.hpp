// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>
#include <unistd.h>

#include <string>
#include <utility>
#include <vector>

#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// Held by one process of this machine at a time, whatever user and environment it has: an abstract
/// Unix socket, which is no file, and which the kernel releases however the process ends. A process
/// in another network namespace (a container with a network of its own) does not see it.
class InstanceLock {
 public:
  /// Takes the lock of that name. The reason, when somebody holds it, is the holder: "pid 123".
  static Expected<InstanceLock> take(const std::string& name);
  /// The holder, without taking the lock; a reason as above, or nothing when nobody holds it.
  static Expected<void> check(const std::string& name);

  struct Held {
    std::string name;
    pid_t holder;  // 0: thousands have asked for it already, and the kernel tells it no more
  };
  /// Locks of this machine whose names begin so, and who holds them. Names that are too long for an
  /// address (98 bytes) and holders of another container are left out.
  static std::vector<Held> held(const std::string& beginning);

  InstanceLock(InstanceLock&& other) noexcept : socket_{std::exchange(other.socket_, -1)} {}
  InstanceLock& operator=(InstanceLock&&) = delete;
  ~InstanceLock();

 private:
  explicit InstanceLock(int socket) : socket_{socket} {}
  int socket_;
  pid_t owner_ = getpid();  // what that forks holds no lock
};

}  // namespace armature
