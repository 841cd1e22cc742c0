// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/path/path.hpp"

namespace armature {

Expected<PathRequest> checked(PathRequest request, Zones zones) {
  auto start = checked(request.start, "the start's");
  if (!start) return tl::unexpected{start.error()};
  auto goal = checked(request.goal, "the goal's");
  if (!goal) return tl::unexpected{goal.error()};
  if (request.focus && !request.focus->allFinite()) {
    return refuse("the point to look at is not finite");
  }
  for (const ForbiddenZone& zone : request.forbidden) {
    if (auto wrong = defect(zone)) return refuse(std::move(*wrong));
  }
  if (zones == Zones::refused && !request.forbidden.empty()) {
    return refuse("this planner does not keep away from forbidden zones, and the goal has some");
  }
  request.start = *start;
  request.goal = *goal;
  return request;
}

}  // namespace armature
