// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "armature/messages/std_msgs.hpp"
#include "armature/runtime/component.hpp"
#include "armature/runtime/plugin.hpp"
#include "armature/runtime/setup.hpp"
#include "buttons.hpp"

namespace armature {
namespace {

constexpr Duration kNextTry = seconds(1);  // to open a device that is gone

}  // namespace

class PendantComponent : public Component {
 public:
  explicit PendantComponent(Setup& setup)
      : Component(setup),
        buttons_{setup.params().text("device")},
        hold_button_{static_cast<int>(setup.params().integer("hold_button"))},
        rearm_button_{static_cast<int>(setup.params().integer("rearm_button"))},
        hold_to_run_{setup.output<msg::Bool>("hold_to_run")},
        rearm_{setup.output<msg::Bool>("rearm")} {
    if (hold_button_ == rearm_button_) {
      setup.params().refuse({"rearm_button"},
                            "the button that is held cannot rearm: letting it go "
                            "and pressing it again would do both");
    }
    setup.activate_every(seconds(1 / setup.params().number("rate_hz")));
  }

  void step(Time now) override {
    if (buttons_.is_open() || now >= next_try_) read(now);
    publish(hold_to_run_, buttons_.held(hold_button_));
    if (buttons_.pressed(rearm_button_)) publish(rearm_, true);
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

  Buttons buttons_;
  int hold_button_, rearm_button_;
  Output<msg::Bool> hold_to_run_, rearm_;
  Time next_try_;
};

}  // namespace armature

ARMATURE_PLUGIN(armature::PendantComponent);
