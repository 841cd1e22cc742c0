// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "watch/outsider.hpp"

namespace armature {

struct LogOptions : WatchOptions {
  bool follow = false;         // what will be said, too, until interrupted
  std::string level = "info";  // the least that is shown: debug, info, warning, error
  std::string component;       // only what it says; empty: all
};

/// `armature log`: prints what running deployments, and whoever else writes on /rosout, told their
/// operators lately.
int print_log(const LogOptions& options);

}  // namespace armature
