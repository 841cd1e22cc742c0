// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "armature/kinds/select/select.hpp"

namespace armature {

/// Greedy choice: the branch nearest to the joint position chosen before it.
class Nearest final : public BranchSelector {
 public:
  static Expected<std::unique_ptr<BranchSelector>> make(const RobotModel& model,
                                                        const Params& params);

  Expected<std::vector<JointVector>> choose(const JointVector& start,
                                            std::span<const IkBranches> waypoints) const override;

 private:
  enum class Nearness { slowest_joint, sum };
  Nearest(const RobotModel& model, Nearness nearness) : model_{&model}, nearness_{nearness} {}

  double travel_time(const JointVector& from, const JointVector& to) const;

  const RobotModel* model_;
  Nearness nearness_;
};

}  // namespace armature
