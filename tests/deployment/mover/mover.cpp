// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/runtime/component.hpp"
#include "armature/runtime/plugin.hpp"
#include "armature/runtime/setup.hpp"

namespace armature {

class Mover final : public Component {
 public:
  explicit Mover(Setup& setup)
      : Component{setup},
        rest_after_{seconds(setup.params().number("rest_after_s"))},
        ends_after_{seconds(setup.params().number("ends_after_s"))},
        hangs_after_{seconds(setup.params().number("hangs_after_s"))},
        talks_{setup.params().flag("talks")},
        beat_{setup.output<msg::Capture>("beat")} {
    setup.activate_every(seconds(0.01));
  }

  void step(Time now) override {
    if (!start_) start_ = now;
    if (!said_) say("moves");
    said_ = true;
    if (talks_) say(std::to_string(now.ns) + std::string(900, '.'));
    while (is_over(hangs_after_, now)) std::this_thread::sleep_for(std::chrono::seconds{1});
    if (finished_) ++steps_after_;
    finished_ = is_over(ends_after_, now);
    if (stop_at_ && !at_rest_) {
      ++steps_to_rest_;
      at_rest_ = now - *stop_at_ >= rest_after_;
      if (at_rest_) say("at rest");
    }
    auto loan = beat_.loan();
    set_stamp(loan->header_().stamp_(), now);
    loan->header_().frame_id_().clear();
    loan->on_(!at_rest_);
    loan.publish();
  }
  void begin_stop(Time now) override {
    stop_at_ = now;
    at_rest_ = rest_after_ == Duration{0};
    say("stops");
  }
  bool stopped() const override { return at_rest_; }
  void stop(Time) override { say(at_rest_ ? "ended at rest" : "ended while it moved"); }
  bool finished() const override { return finished_; }
  void summarize(Summary& summary) const override {
    summary.text("steps_to_rest", "steps until it was at rest", std::to_string(steps_to_rest_));
    summary.text("steps_after", "steps after it had finished", std::to_string(steps_after_));
  }

 private:
  bool is_over(Duration after, Time now) const {
    return after > Duration{0} && now - *start_ >= after;
  }

  Duration rest_after_, ends_after_, hangs_after_;
  bool talks_;
  Output<msg::Capture> beat_;
  std::optional<Time> start_, stop_at_;
  bool said_ = false, at_rest_ = false, finished_ = false;
  int steps_to_rest_ = 0, steps_after_ = 0;
};

}  // namespace armature

ARMATURE_PLUGIN(armature::Mover);
