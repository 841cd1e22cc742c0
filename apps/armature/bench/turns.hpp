// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

namespace armature::bench {

/// Contestants who all do the same items, several times.
struct Turns {
  std::size_t contestants = 0, items = 0;
  int repetitions = 1;
  std::uint64_t order = 1;                    // seed of the order of work
  std::function<void(double part)> progress;  // 0 to 1; may be empty
};

/// 50 items at a time, the contestants take turns in random order, so that whatever slows the
/// machine slows all of them. `go` does the items [from, to).
void take_turns(
    const Turns& turns,
    const std::function<void(std::size_t contestant, std::size_t from, std::size_t to)>& go);

}  // namespace armature::bench
