// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/select/select.hpp"
#include "select_nearest_parameters.hpp"

namespace armature::select::nearest {

/// Greedy choice: the branch nearest to the joint position chosen before it.
class Nearest final : public BranchSelector {
 public:
  Nearest(const RobotModel& model, const Parameters& parameters)
      : model_{&model}, parameters_{parameters} {}
  Nearest(const RobotModel& model, const Params& params)
      : Nearest{model, Parameters::read(params)} {}

  Expected<std::vector<JointVector>> choose(const JointVector& start,
                                            std::span<const IkBranches> waypoints) const override;

 private:
  double travel_time(const JointVector& from, const JointVector& to) const;

  const RobotModel* model_;
  Parameters parameters_;
};

}  // namespace armature::select::nearest
