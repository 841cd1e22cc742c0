#include <algorithm>
#include <cmath>
#include <string>

#include "armature/runtime/component/component.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/runtime/component/setup.hpp"
#include "@TARGET@_parameters.hpp"  // made from plugin.yaml
#include "@TARGET@_ports.hpp"

namespace @NAMESPACE@ {
/// Hears an arm and speaks up; it commands nothing.
class @CLASS@ final : public Component {
 public:
  explicit @CLASS@(Setup& setup)
      : Component{setup}, parameters_{Parameters::read(setup.params())}, ports_{setup} {}

  /// Once for every message, or for several that came together. Must not wait.
  void step(Time) override {
    double fastest = 0;
    for (std::size_t i = 0; i < ports_.measured_js.size(); ++i) {
      for (const double speed : ports_.measured_js[i].velocity_()) {
        if (std::isfinite(speed)) fastest = std::max(fastest, std::abs(speed));
      }
    }
    greatest_ = std::max(greatest_, fastest);
    auto told = ports_.greatest_speed.loan();
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
  Ports ports_;
  double greatest_ = 0;
};
}  // namespace @NAMESPACE@
ARMATURE_PLUGIN(@NAMESPACE@::@CLASS@);
