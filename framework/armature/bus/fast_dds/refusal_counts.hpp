// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "armature/bus/transport.hpp"

namespace armature ARMATURE_EXPORT {

/// Counts the samples that were refused, by writer. Each of the first writers by itself, and all
/// that come after them together.
class RefusalCounts {
 public:
  static constexpr std::size_t kMaxWriters = 100;

  void add(const std::string& writer) {
    if (const auto known = counts_.find(writer); known != counts_.end()) {
      ++known->second;
    } else if (counts_.size() < kMaxWriters) {
      counts_.emplace(writer, 1);
    } else {
      ++others_;
    }
  }
  std::vector<RefusedSamples> all() const {
    std::vector<RefusedSamples> all;
    for (const auto& [writer, count] : counts_) all.push_back({.writer = writer, .count = count});
    if (others_ > 0) all.push_back({.writer = "further writers", .count = others_});
    return all;
  }

 private:
  std::map<std::string, std::uint64_t> counts_;
  std::uint64_t others_ = 0;
};

}  // namespace armature
