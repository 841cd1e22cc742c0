// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <utility>

#include "armature/values/time.hpp"

namespace armature::report::joints {

/// Values, each of which holds from its stamp until the next one's. Keeps at most `kMax`.
template <class Value>
class Timeline {
 public:
  static constexpr std::size_t kMax = 1024;

  /// Of two values with one stamp the later one holds.
  void add(Time stamp, Value value) {
    if (entries_.size() == kMax) entries_.pop_front();
    const auto later =
        std::upper_bound(entries_.begin(), entries_.end(), stamp,
                         [](Time time, const Entry& entry) { return time < entry.stamp; });
    entries_.insert(later, Entry{stamp, std::move(value)});
  }

  struct Entry {
    Time stamp;
    Value value;
  };
  /// What holds at `time`, or nullptr; what held before is forgotten, so ask in order of time.
  const Entry* at(Time time) {
    while (entries_.size() > 1 && entries_[1].stamp <= time) entries_.pop_front();
    const bool holds = !entries_.empty() && entries_.front().stamp <= time;
    return holds ? &entries_.front() : nullptr;
  }

 private:
  std::deque<Entry> entries_;
};

}  // namespace armature::report::joints
