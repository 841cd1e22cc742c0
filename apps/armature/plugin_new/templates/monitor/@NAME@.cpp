#include <algorithm>
#include <cmath>
#include <string>

#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/std_msgs.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/runtime/component/setup.hpp"
#include "@TARGET@_parameters.hpp"  // made from plugin.yaml

namespace @NAMESPACE@ {
/// Hears an arm and speaks up; it commands nothing.
class @CLASS@ final : public Component {
 public:
  explicit @CLASS@(Setup& setup)
      : Component{setup},
        parameters_{Parameters::read(setup.params())},
        measured_js_{setup.input<msg::JointState>("measured_js")},
        greatest_speed_{setup.output<msg::Float64>("greatest_speed")} {}

  /// Once for every message, or for several that came together. Must not wait.
  void step(Time) override {
    double fastest = 0;
    for (std::size_t i = 0; i < measured_js_.size(); ++i) {
      for (const double speed : measured_js_[i].velocity_()) {
        if (std::isfinite(speed)) fastest = std::max(fastest, std::abs(speed));
      }
    }
    greatest_ = std::max(greatest_, fastest);
    auto told = greatest_speed_.loan();
    told->data_() = fastest;
    told.publish();
    if (fastest > parameters_.max_speed) {
      degraded("a joint moves at " + std::to_string(fastest) + " rad/s, more than " +
               std::to_string(parameters_.max_speed));
    } else {
      healthy();
    }
  }

  void summarize(Summary& summary) const override {
    summary.metric("greatest_speed_rad_s", "greatest joint speed", greatest_);
  }

 private:
  Parameters parameters_;
  Input<msg::JointState> measured_js_;
  Output<msg::Float64> greatest_speed_;
  double greatest_ = 0;
};
}  // namespace @NAMESPACE@
ARMATURE_PLUGIN(@NAMESPACE@::@CLASS@);
