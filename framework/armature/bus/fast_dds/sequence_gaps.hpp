// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "armature/bus/fast_dds/discovery.hpp"
#include "armature/values/recent.hpp"

namespace armature ARMATURE_EXPORT {

/// Finds by the numbers that writers give their samples how many did not arrive. What a writer sent
/// before its first sample that came was not for this reader; what is lost at the end nobody sees.
class SequenceGaps {
 public:
  /// How many samples of `writer` are missing between its last one and this one, numbered
  /// `sequence`.
  std::uint64_t lost_before(const Guid& writer, std::uint64_t sequence) {
    std::uint64_t* last = last_.find(writer);
    if (!last) last_.put(writer, sequence);
    if (!last || sequence <= *last) return 0;
    return sequence - std::exchange(*last, sequence) - 1;
  }
  /// The count of the writers that are remembered: those that were heard last.
  std::size_t writers() const { return last_.size(); }

 private:
  Recent<Guid, std::uint64_t> last_;
};

}  // namespace armature
