// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "armature/values/expected.hpp"

namespace armature {

/// Held while a deployment runs, so that a second start of the same one on the same domain is told
/// who runs it instead of two of them commanding one arm. Released by the kernel however the
/// process ends.
class InstanceLock {
 public:
  /// The reason names the pid and domain of the holder.
  static Expected<InstanceLock> take(const std::string& deployment, int domain);
  InstanceLock(InstanceLock&& other) noexcept;
  InstanceLock& operator=(InstanceLock&&) = delete;
  ~InstanceLock();

 private:
  explicit InstanceLock(int file) : file_{file} {}
  int file_;
};

}  // namespace armature
