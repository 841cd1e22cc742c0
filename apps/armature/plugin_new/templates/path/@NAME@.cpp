#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "armature/kinds/path/path.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "@TARGET@_parameters.hpp"  // made from plugin.yaml

namespace @NAMESPACE@ {
/// The tool goes straight and turns about one axis, both at an even pace.
class @CLASS@ final : public PathPlanner {
 public:
  explicit @CLASS@(const RobotModel&, const Params& params) : parameters_{Parameters::read(params)} {}

  Expected<Path> plan(const PathRequest& request) const override {
    const auto valid = checked(request);
    if (!valid) return tl::unexpected{valid.error()};
    const auto turn = turn_between(valid->start.orientation, valid->goal.orientation);
    if (!turn) return refuse("the goal is a direction where the start is a rotation, or the reverse");
    const Eigen::Vector3d way = valid->goal.position - valid->start.position;
    const double steps = std::max({1.0, way.norm() / parameters_.step_m, turn->angle() / parameters_.step_rad});
    if (steps > kMaxSamples) return refuse("more than 10000 samples: the goal is too far away");
    const int n = static_cast<int>(std::ceil(steps));
    PathSegment straight;
    for (int i = 0; i <= n; ++i) {
      const double s = static_cast<double>(i) / n;
      straight.samples.push_back({.s = s, .pose = at(valid->start, way, *turn, s)});
    }
    straight.samples.back().pose = valid->goal;
    return Path{straight};
  }

 private:
  static constexpr double kMaxSamples = 10000;

  /// The shortest turn from `a` to `b`; nothing when one is a direction and the other a rotation.
  static std::optional<Eigen::AngleAxisd> turn_between(const Orientation& a, const Orientation& b) {
    if (a.index() != b.index()) return std::nullopt;
    if (const auto* from = std::get_if<Eigen::Quaterniond>(&a)) {
      return Eigen::AngleAxisd{std::get<Eigen::Quaterniond>(b) * from->inverse()};
    }
    return Eigen::AngleAxisd{Eigen::Quaterniond::FromTwoVectors(std::get<Direction>(a).unit,
                                                                std::get<Direction>(b).unit)};
  }
  static ToolPose at(const ToolPose& start, const Eigen::Vector3d& way, const Eigen::AngleAxisd& turn, double s) {
    const Eigen::Quaterniond turned{Eigen::AngleAxisd{s * turn.angle(), turn.axis()}};
    ToolPose pose{start.position + s * way, start.orientation};
    if (const auto* from = std::get_if<Eigen::Quaterniond>(&start.orientation)) {
      pose.orientation = (turned * *from).normalized();
    } else {
      pose.orientation = Direction{(turned * std::get<Direction>(start.orientation).unit).normalized()};
    }
    return pose;
  }

  Parameters parameters_;
};
}  // namespace @NAMESPACE@
ARMATURE_PLUGIN(@NAMESPACE@::@CLASS@);
