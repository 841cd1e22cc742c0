#include "armature/kinds/trajectory/one_law.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace @NAMESPACE@ {
namespace {

/// The shape of a motion along `curve` under `law`: for every joint a quintic from each knot to the
/// next that has the curve's position, velocity and acceleration at both.
std::vector<Quintic> shape(const JointCurve& curve, const TimeLaw& law,
                           std::span<const double> knots) {
  std::vector<Quintic> pieces;
  JointState from = state_along(curve, law, knots.front());
  for (std::size_t i = 1; i < knots.size(); ++i) {
    const JointState to = state_along(curve, law, knots[i]);
    for (int j = 0; j < curve.dof(); ++j) {
      pieces.push_back(Quintic::between({from.q[j], from.v[j], from.a[j]},
                                        {to.q[j], to.v[j], to.a[j]}, knots[i] - knots[i - 1]));
    }
    from = to;
  }
  return pieces;
}

}  // namespace

/// `timed` finds the shortest duration of each leg, from stop to stop, that keeps the limits.
class @CLASS@ final : public TrajectoryPlanner {
 public:
  Expected<Trajectory> plan(const TrajectoryRequest& request) const override {
    return timed(request, under_one_law(shape));
  }
};
}  // namespace @NAMESPACE@
ARMATURE_PLUGIN(@NAMESPACE@::@CLASS@);
