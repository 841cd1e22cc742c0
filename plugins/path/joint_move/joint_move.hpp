// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "armature/kinds/path/path.hpp"

namespace armature {

/// One joint segment, rest to rest.
class JointMove final : public PathPlanner {
 public:
  static Expected<std::unique_ptr<PathPlanner>> make(const Params& params);

  Expected<Path> plan(const PathRequest& request) const override;

 private:
  explicit JointMove(std::optional<double> duration_s) : duration_s_{duration_s} {}

  std::optional<double> duration_s_;
};

}  // namespace armature
