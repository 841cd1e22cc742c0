#include <limits>
#include <string>

#include "@TARGET@_parameters.hpp"  // made from plugin.yaml
#include "armature/kinds/select/select.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace @NAMESPACE@ {
/// From branch to nearest branch, beginning where the arm is.
class @CLASS@ final : public BranchSelector {
 public:
  @CLASS@(const RobotModel& robot, const Params& params)
      : robot_{robot},
        weights_{
            JointVector::LinSpaced(robot.dof(), Parameters::read(params).first_joint_weight, 1)} {}

  Expected<std::vector<JointVector>> choose(const JointVector& start,
                                            std::span<const IkBranches> waypoints) const override {
    if (auto wrong = invalid_input(robot_, start, waypoints)) return refuse(*wrong);
    std::vector<JointVector> chosen;
    for (const IkBranches& branches : waypoints) {
      const JointVector before = chosen.empty() ? start : chosen.back();
      double shortest = std::numeric_limits<double>::infinity();
      JointVector nearest;
      for (const IkBranch& branch : branches) {
        JointVector q = branch.q;
        if (!unwind(robot_, before, q)) continue;  // no turn of it is within the limits
        const double way = weights_.dot((q - before).cwiseAbs());
        if (way < shortest) shortest = way, nearest = q;
      }
      if (nearest.size() == 0) {
        return refuse("waypoint " + std::to_string(chosen.size() + 1) + " of " +
                      std::to_string(waypoints.size()) + ": no branch within limits");
      }
      chosen.push_back(nearest);
    }
    return chosen;
  }

 private:
  const RobotModel& robot_;
  JointVector weights_;
};
}  // namespace @NAMESPACE@
ARMATURE_PLUGIN(@NAMESPACE@::@CLASS@);
