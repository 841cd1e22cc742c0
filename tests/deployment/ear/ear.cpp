// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "test_ear_parameters.hpp"

namespace armature::test::ear {

class Ear final : public Component {
 public:
  explicit Ear(Setup& setup)
      : Component{setup},
        parameters_{Parameters::read(setup.params())},
        beat_{setup.input<msg::Capture>("beat")},
        young_{setup.input<msg::Capture>("young")},
        order_{setup.input<msg::Capture>("order")},
        states_{setup.input<msg::ComponentStates>("states")} {
    setup.activate_every(seconds(0.01));
  }

  void step(Time now) override {
    if (!start_) start_ = now;
    finished_ = now - *start_ >= seconds(parameters_.listens);
    if (parameters_.needs_beats) {
      if (young_.latest()) {
        healthy();
      } else {
        degraded("no young beat");
      }
    }
    if (beat_.fresh()) delays_s_.push_back(age_s(beat_, now));
    if (beat_.latest()) oldest_s_ = std::max(oldest_s_, age_s(beat_, now));
    if (young_.latest()) oldest_young_s_ = std::max(oldest_young_s_, age_s(young_, now));
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const Time ordered = stamp_of(order_[i].header_().stamp_());
      ++orders_;
      if (ordered <= last_order_) ++orders_again_;
      last_order_ = ordered;
      oldest_order_s_ = std::max(oldest_order_s_, to_seconds(now - ordered));
    }
    for (std::size_t i = 0; i < states_.size(); ++i) {
      for (const auto& state : states_[i].components_()) told_of_.insert(state.component_());
    }
  }

  bool finished() const override { return finished_; }

  void summarize(Summary& summary) const override {
    if (!delays_s_.empty()) summary.metric("delay_s", "delay [s]", delays_s_.back());
    summary.series("delays_s", "delay of each beat [s]", delays_s_);
    if (delays_s_.empty() && parameters_.minds_silence) {
      summary.not_measured("delay_s", "delay [s]", "no beat was heard");
      summary.failed("deaf", "beat tells nothing");
    }
    if (delays_s_.empty() && parameters_.expects_silence) {
      summary.does_not_apply("delay_s", "delay [s]", "no beat was to come");
    }
    summary.metric("oldest_s", "oldest beat [s]", oldest_s_);
    summary.metric("oldest_young_s", "oldest young beat [s]", oldest_young_s_);
    summary.metric("orders", "commands", orders_);
    summary.metric("orders_again", "commands told again",
                   parameters_.reports_debts ? -3 : orders_again_);
    summary.metric("oldest_order_s", "oldest command [s]",
                   parameters_.reports_nan ? std::nan("") : oldest_order_s_);
    if (parameters_.undeclared) summary.metric("surprise_s", "surprise [s]", 1);
    std::string names;
    for (const std::string& name : told_of_) names += name + " ";
    summary.text("told_of", "components that the runtime told of", names);
  }

 private:
  static double age_s(const Input<msg::Capture>& input, Time now) {
    return to_seconds(now - stamp_of(input.latest()->header_().stamp_()));
  }

  Parameters parameters_;
  Input<msg::Capture> beat_, young_, order_;
  Input<msg::ComponentStates> states_;
  std::optional<Time> start_;
  bool finished_ = false;
  std::vector<double> delays_s_;
  double oldest_s_ = 0, oldest_young_s_ = 0, oldest_order_s_ = 0;
  int orders_ = 0, orders_again_ = 0;
  Time last_order_{-1};
  std::set<std::string> told_of_;
};

}  // namespace armature::test::ear

ARMATURE_PLUGIN(armature::test::ear::Ear);
