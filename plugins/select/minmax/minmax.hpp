// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "armature/kinds/select/select.hpp"
#include "least_path.hpp"
#include "moves.hpp"

namespace armature {

/// The choice over a whole path whose greatest move is least; of those the one whose moves are
/// shortest together.
class MinMax final : public BranchSelector {
 public:
  static Expected<std::unique_ptr<BranchSelector>> make(const RobotModel& model,
                                                        const Params& params);

  Expected<std::vector<JointVector>> choose(const JointVector& start,
                                            std::span<const IkBranches> waypoints) const override;

 private:
  MinMax(const RobotModel& model, const minmax::Rules& rules)
      : model_{&model}, rules_{rules}, moves_{model, rules} {}

  Expected<minmax::Waypoints> that_can_stand(std::span<const IkBranches> waypoints) const;
  std::string blocked(const minmax::Layers& layers, const minmax::Waypoints& waypoints) const;

  const RobotModel* model_;
  minmax::Rules rules_;
  minmax::Moves moves_;
};

}  // namespace armature
