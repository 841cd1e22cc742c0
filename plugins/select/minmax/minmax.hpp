// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "armature/kinds/select/select.hpp"
#include "min_path.hpp"
#include "moves.hpp"

namespace armature::select::minmax {

/// The choice over a whole path whose greatest move is least; of those the one whose moves are
/// shortest together.
class MinMax final : public BranchSelector {
 public:
  MinMax(const RobotModel& model, const Parameters& parameters)
      : model_{&model}, parameters_{parameters}, moves_{model, parameters} {}
  /// Refuses to go by the inertia of a robot that states none.
  static Expected<std::unique_ptr<BranchSelector>> make(const RobotModel& model,
                                                        const Params& params);

  Expected<std::vector<JointVector>> choose(const JointVector& start,
                                            std::span<const IkBranches> waypoints) const override;

 private:
  Expected<Waypoints> that_can_stand(std::span<const IkBranches> waypoints) const;
  std::string blocked(const Layers& layers, const Waypoints& waypoints) const;

  const RobotModel* model_;
  Parameters parameters_;
  Moves moves_;
};

}  // namespace armature::select::minmax
