// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace armature {

struct BusBenchOptions {
  int rounds = 20;
  std::size_t picture_bytes = 1280 * 720;
  int domain = 101;      // DDS
  bool answers = false;  // this is the process that the bench has started to answer it
  bool json = false;
};

/// `armature bench bus`: from publishing to the step that it activates, beside two threads that
/// wake each other; and round trips to another process beside those of Fast DDS alone, in the same
/// minute on the same machine. Exit code 1 when a goal is missed.
int bench_bus(const BusBenchOptions& options);

}  // namespace armature
