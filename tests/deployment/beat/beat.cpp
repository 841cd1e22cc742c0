// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <thread>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/runtime/component.hpp"
#include "armature/runtime/plugin.hpp"
#include "armature/runtime/setup.hpp"

namespace armature {

class Beat final : public Component {
 public:
  explicit Beat(Setup& setup)
      : Component{setup},
        beats_{setup.params().integer("beats")},
        beat_{setup.output<msg::Capture>("beat")} {
    setup.activate_every(seconds(0.01));
    const double construction_s = setup.params().number("construction_s");
    if (construction_s == 0) return;
    say("being constructed");
    std::this_thread::sleep_for(std::chrono::duration<double>{construction_s});
  }

  void step(Time now) override {
    if (beats_ > 0 && sent_ == beats_) return;
    ++sent_;
    auto loan = beat_.loan();
    set_stamp(loan->header_().stamp_(), now);
    loan->header_().frame_id_().clear();
    loan->on_(true);
    loan.publish();
  }

 private:
  std::int64_t beats_, sent_ = 0;
  Output<msg::Capture> beat_;
};

}  // namespace armature

ARMATURE_PLUGIN(armature::Beat);
