// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "test_mover_parameters.hpp"

namespace armature::test::mover {

class Mover final : public Component {
 public:
  explicit Mover(Setup& setup)
      : Component{setup},
        parameters_{Parameters::read(setup.params())},
        beat_{setup.output<msg::Capture>("beat")} {
    setup.activate_every(seconds(0.01));
  }

  void step(Time now) override {
    if (!start_) start_ = now;
    if (!said_) log("moves");
    said_ = true;
    if (parameters_.talks) log(std::to_string(now.ns) + std::string(900, '.'));
    while (is_over(parameters_.hangs_after, now))
      std::this_thread::sleep_for(std::chrono::seconds{1});
    if (finished_) ++steps_after_;
    finished_ = is_over(parameters_.ends_after, now);
    if (stop_at_ && !at_rest_) {
      ++steps_to_rest_;
      at_rest_ = now - *stop_at_ >= seconds(parameters_.rest_after);
      if (at_rest_) log("at rest");
    }
    auto loan = beat_.loan();
    set_stamp(loan->header_().stamp_(), now);
    loan->header_().frame_id_().clear();
    loan->on_(!at_rest_);
    loan.publish();
  }
  void begin_stop(Time now) override {
    stop_at_ = now;
    at_rest_ = parameters_.rest_after == 0;
    log("stops");
  }
  bool stopped() const override { return at_rest_; }
  void stop(Time) override { log(at_rest_ ? "ended at rest" : "ended while it moved"); }
  bool finished() const override { return finished_; }
  void summarize(Summary& summary) const override {
    summary.text("steps_to_rest", "steps until it was at rest", std::to_string(steps_to_rest_));
    summary.text("steps_after", "steps after it had finished", std::to_string(steps_after_));
  }

 private:
  bool is_over(double after_s, Time now) const {
    return after_s > 0 && now - *start_ >= seconds(after_s);
  }

  Parameters parameters_;
  Output<msg::Capture> beat_;
  std::optional<Time> start_, stop_at_;
  bool said_ = false, at_rest_ = false, finished_ = false;
  int steps_to_rest_ = 0, steps_after_ = 0;
};

}  // namespace armature::test::mover

ARMATURE_PLUGIN(armature::test::mover::Mover);
