// SPDX-License-Identifier: Apache-2.0
#include "line_of_sight.hpp"

#include <fmt/format.h>

#include <cstddef>

namespace armature::sim::optical_tracker {

std::optional<std::string> LineOfSight::obstacle(double elapsed_s, double distance_m) const {
  for (std::size_t i = 0; i < hidden_s.size(); i += 2) {
    if (elapsed_s >= hidden_s[i] && elapsed_s < hidden_s[i + 1]) return "its spheres are hidden";
  }
  if (distance_m < min_distance_m || distance_m > max_distance_m) {
    return fmt::format("it is {:.0f} mm away, the tracker sees from {:g} to {:g} mm",
                       1e3 * distance_m, 1e3 * min_distance_m, 1e3 * max_distance_m);
  }
  return std::nullopt;
}

std::optional<std::string> defect(const std::vector<double>& hidden_s) {
  if (hidden_s.size() % 2 != 0) {
    return fmt::format("{} numbers; two for each time are needed: from, until", hidden_s.size());
  }
  for (std::size_t i = 0; i < hidden_s.size(); i += 2) {
    if (hidden_s[i] > hidden_s[i + 1]) {
      return fmt::format("from {:g} s until {:g} s is no time", hidden_s[i], hidden_s[i + 1]);
    }
  }
  return std::nullopt;
}

}  // namespace armature::sim::optical_tracker
