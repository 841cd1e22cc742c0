// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/path/path.hpp"

namespace armature {

Expected<PathRequest> checked(PathRequest request) {
  auto start = checked(request.start, "the start's");
  if (!start) return tl::unexpected{start.error()};
  auto goal = checked(request.goal, "the goal's");
  if (!goal) return tl::unexpected{goal.error()};
  if (request.focus && !request.focus->allFinite()) {
    return refuse("the point to look at is not finite");
  }
  request.start = *start;
  request.goal = *goal;
  return request;
}

}  // namespace armature
