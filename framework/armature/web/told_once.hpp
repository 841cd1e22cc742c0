// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <set>
#include <string>

namespace armature ARMATURE_EXPORT {

/// What has been told, so that each is told once: at most a hundred, whatever strangers do.
class ToldOnce {
 public:
  /// Whether this is to be told; from now on it has been.
  bool is_new(const std::string& what) {
    constexpr std::size_t kMost = 100;
    return told_.size() < kMost && told_.insert(what).second;
  }

 private:
  std::set<std::string> told_;
};

}  // namespace armature
