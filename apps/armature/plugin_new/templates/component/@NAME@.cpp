#include <Eigen/Core>
#include <algorithm>
#include <optional>

#include "@TARGET@_parameters.hpp"  // made from plugin.yaml
#include "@TARGET@_ports.hpp"
#include "armature/messages/geometry_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace @NAMESPACE@ {
class @CLASS@ final : public Component {
 public:
  /// Takes what plugin.yaml declares: parameters, inputs and outputs.
  explicit @CLASS@(Setup& setup)
      : Component{setup}, parameters_{Parameters::read(setup.params())}, ports_{setup} {}

  /// Once for every message, or for several that came together. Must not wait.
  void step(Time) override {
    for (std::size_t i = 0; i < ports_.tool_pose.size(); ++i) take(ports_.tool_pose[i]);
    top_speed_ = std::max(top_speed_, speed_);
    auto message = ports_.tool_speed.loan();
    message->data_() = speed_;
    message.publish();
  }

  /// For the table at the end of the run, and for `goals:` of a deployment.
  void summarize(Summary& summary) const override {
    summary.metric("top_speed_m_s", "top speed of the tool [m/s]", top_speed_);
  }

 private:
  void take(const msg::PoseStamped& pose) {
    const auto& p = pose.pose_().position_();
    const Eigen::Vector3d position{p.x_(), p.y_(), p.z_()};
    const Time stamp = stamp_of(pose.header_().stamp_());  // when it was there, not when we heard
    if (!position.allFinite()) return degraded("a position is not finite");
    healthy();
    if (last_ && stamp > last_->stamp) {
      const double dt = to_seconds(stamp - last_->stamp);
      const double measured = (position - last_->position).norm() / dt;
      speed_ += dt / (dt + parameters_.smoothing) * (measured - speed_);
    }
    last_ = {stamp, position};
  }

  struct Seen {
    Time stamp;
    Eigen::Vector3d position;
  };
  Parameters parameters_;
  Ports ports_;
  std::optional<Seen> last_;
  double speed_ = 0, top_speed_ = 0;
};
}  // namespace @NAMESPACE@
ARMATURE_PLUGIN(@NAMESPACE@::@CLASS@);
