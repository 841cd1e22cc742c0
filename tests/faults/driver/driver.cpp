// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "armature/messages/std_msgs.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace armature {

class Driver final : public Component {
 public:
  explicit Driver(Setup& setup) : Component{setup}, note_{setup.input<msg::String>("note")} {
    setup.activate_every(seconds(0.01));
  }

  void step(Time now) override {
    if (!start_) start_ = now;
    if (note_.fresh()) last_note_ = now - *start_;
  }
  void summarize(Summary& summary) const override {
    summary.metric("last_note_s", "last note [s]", to_seconds(last_note_));
  }

 private:
  Input<msg::String> note_;
  std::optional<Time> start_;
  Duration last_note_{0};
};

}  // namespace armature

ARMATURE_PLUGIN(armature::Driver);
