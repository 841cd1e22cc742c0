// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <vector>

namespace armature::bench {

/// Other processes that read the bench's joint state: `armature topic hz`, silent. They end with
/// this object, and with this process.
class Readers {
 public:
  /// Throws std::system_error.
  Readers(int count, int domain);
  ~Readers();
  Readers(const Readers&) = delete;
  Readers& operator=(const Readers&) = delete;

 private:
  std::vector<pid_t> processes_;
};

}  // namespace armature::bench
