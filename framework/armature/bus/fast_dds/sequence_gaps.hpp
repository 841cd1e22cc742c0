// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "armature/bus/fast_dds/discovery.hpp"

namespace armature ARMATURE_EXPORT {

/// Finds by the numbers that writers give their samples how many did not arrive. What a writer sent
/// before its first sample that came was not for this reader; what is lost at the end nobody sees.
class SequenceGaps {
 public:
  /// How many samples of `writer` are missing between its last one and this one, numbered
  /// `sequence`.
  std::uint64_t lost_before(const Guid& writer, std::uint64_t sequence) {
    const auto [place, is_first] = last_.try_emplace(writer, sequence);
    std::uint64_t& last = place->second;
    if (is_first || sequence <= last) return 0;
    const std::uint64_t lost = sequence - last - 1;
    last = sequence;
    return lost;
  }

 private:
  std::map<Guid, std::uint64_t> last_;
};

}  // namespace armature
