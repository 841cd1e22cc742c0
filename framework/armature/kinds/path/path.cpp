// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/path/path.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <utility>

namespace armature {

Expected<PathRequest> checked(PathRequest request, PathSkills skills) {
  auto start = checked(request.start, "the start's");
  if (!start) return tl::unexpected{start.error()};
  auto goal = checked(request.goal, "the goal's");
  if (!goal) return tl::unexpected{goal.error()};
  for (std::size_t i = 0; i < request.through.size(); ++i) {
    auto key = checked(request.through[i], fmt::format("key pose {}'s", i + 1));
    if (!key) return tl::unexpected{key.error()};
    request.through[i] = *key;
  }
  if (request.focus && !request.focus->allFinite()) {
    return refuse("the point to look at is not finite");
  }
  for (const ForbiddenZone& zone : request.forbidden) {
    if (auto wrong = defect(zone)) return refuse(std::move(*wrong));
  }
  if (!skills.zones && !request.forbidden.empty()) {
    return refuse("this path knows nothing of forbidden zones, and the goal has some");
  }
  if (!skills.key_poses && !request.through.empty()) {
    return refuse(fmt::format("this path goes from a start to a goal; it knows no way through {}",
                              request.through.size() == 1
                                  ? "a key pose"
                                  : fmt::format("{} key poses", request.through.size())));
  }
  request.start = *start;
  request.goal = *goal;
  return request;
}

}  // namespace armature
