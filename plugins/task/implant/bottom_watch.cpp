// SPDX-License-Identifier: Apache-2.0
#include "bottom_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace armature::task::implant {

BottomWatch::BottomWatch(const std::vector<Destination>& destinations, std::string tool,
                         std::string at)
    : tool_{std::move(tool)}, at_{std::move(at)} {
  for (const Destination& destination : destinations) {
    bottoms_.push_back({destination, std::numeric_limits<double>::infinity()});
  }
}

void BottomWatch::see(const Eigen::Isometry3d& base_T_flange) {
  for (Bottom& bottom : bottoms_) {
    const Eigen::Vector3d tip = base_T_flange * bottom.flange_tip;
    bottom.min_distance_m = std::min(bottom.min_distance_m, (tip - bottom.base_bottom).norm());
  }
}

std::optional<std::string> BottomWatch::missed(std::size_t sites, double max_m) const {
  const auto last = bottoms_.begin() + static_cast<std::ptrdiff_t>(sites);
  const auto worst = std::ranges::max_element(bottoms_.begin(), last, {}, &Bottom::min_distance_m);
  if (worst == last || worst->min_distance_m <= max_m) return std::nullopt;
  return fmt::format("{} came no nearer than {:.2f} mm to {} site {}, {:g} mm are allowed", tool_,
                     1e3 * worst->min_distance_m, at_, worst - bottoms_.begin() + 1, 1e3 * max_m);
}

}  // namespace armature::task::implant
