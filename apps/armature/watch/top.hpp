// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "watch/outsider.hpp"

namespace armature {

struct TopOptions : WatchOptions {
  std::string deployment;   // empty: all of the domain
  std::uint64_t count = 0;  // looks; 0: until interrupted
  double interval_s = 1;
};

/// Shows how the components of running deployments are: on a terminal as a live table with keys,
/// elsewhere as one table, or line of JSON, after the other.
int watch_components(const TopOptions& options);

}  // namespace armature
