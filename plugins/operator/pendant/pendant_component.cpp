// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "armature/messages/std_msgs.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "buttons.hpp"
#include "operator_pendant_parameters.hpp"
#include "operator_pendant_ports.hpp"

namespace armature::operator_::pendant {
namespace {

constexpr Duration kNextTry = seconds(1);  // to open a device that is gone

}  // namespace

class PendantComponent : public Component {
 public:
  explicit PendantComponent(Setup& setup)
      : Component(setup),
        parameters_{Parameters::read(setup.params())},
        buttons_{parameters_.device},
        ports_{setup} {
    if (parameters_.hold_button == parameters_.rearm_button) {
      setup.params().refuse({"rearm_button"},
                            "the button that is held cannot rearm: letting it go "
                            "and pressing it again would do both");
    }
    setup.activate_every(seconds(1 / parameters_.rate));
  }

  void step(Time now) override {
    if (buttons_.is_open() || now >= next_try_) read(now);
    publish(ports_.hold_to_run, buttons_.held(parameters_.hold_button));
    if (buttons_.pressed(parameters_.rearm_button)) publish(ports_.rearm, true);
  }

 private:
  void read(Time now) {
    const std::string why = buttons_.update();
    if (why.empty()) return healthy();
    degraded(why);
    next_try_ = now + kNextTry;
  }

  static void publish(Output<msg::Bool>& output, bool value) {
    auto loan = output.loan();
    loan->data_(value);
    loan.publish();
  }

  Parameters parameters_;
  Buttons buttons_;
  Ports ports_;
  Time next_try_;
};

}  // namespace armature::operator_::pendant

ARMATURE_PLUGIN(armature::operator_::pendant::PendantComponent);
