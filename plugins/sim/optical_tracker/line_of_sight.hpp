// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace armature::sim::optical_tracker {

/// What keeps a tracker from seeing a body.
struct LineOfSight {
  double min_distance_m = 0, max_distance_m = 0;  // from the tracker: what it can see at all
  std::vector<double> hidden_s;  // from, until, from, until...: something is in the way

  /// Why a body `distance_m` away is not seen `elapsed_s` after the start, or nullopt.
  std::optional<std::string> obstacle(double elapsed_s, double distance_m) const;
};

/// What is wrong with hidden_s, or nullopt.
std::optional<std::string> defect(const std::vector<double>& hidden_s);

}  // namespace armature::sim::optical_tracker
