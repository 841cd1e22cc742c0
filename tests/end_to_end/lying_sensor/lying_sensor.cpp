// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <deque>
#include <optional>

#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/std_msgs.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "test_lying_sensor_parameters.hpp"
#include "test_lying_sensor_ports.hpp"

namespace armature::test::lying_sensor {

class LyingSensor final : public Component {
 public:
  explicit LyingSensor(Setup& setup)
      : Component{setup}, parameters_{Parameters::read(setup.params())}, ports_{setup} {}

  void step(Time now) override {
    if (!start_) start_ = now;
    const double passed_s = to_seconds(now - *start_);
    if (!stop_asked_ && passed_s >= parameters_.stop_at) {
      stop_asked_ = true;
      auto stop = ports_.stop.loan();
      stop->data_() = true;
      stop.publish();
    }
    for (std::size_t i = 0; i < ports_.true_js.size(); ++i) tell(ports_.true_js[i], passed_s);
  }

 private:
  void tell(const msg::JointState& truth, double passed_s) {
    using enum Parameters::Lie;
    auto told = ports_.measured_js.loan();
    *told = truth;
    past_.push_back(truth);
    const double lies_s = passed_s - parameters_.from;
    double& q = told->position_().at(static_cast<std::size_t>(parameters_.joint));
    if (lies_s < 0 || parameters_.lie == none) {
      while (past_.size() > (parameters_.lie == late ? kLate : 1)) past_.pop_front();
    } else if (parameters_.lie == stuck) {
      told->position_() = past_.front().position_();
      told->velocity_() = past_.front().velocity_();
      past_.pop_back();
    } else if (parameters_.lie == late) {
      told->position_() = past_.front().position_();
      told->velocity_() = past_.front().velocity_();
      past_.pop_front();
    } else if (parameters_.lie == negated) {
      q = -q;
    } else {
      q += parameters_.amount * share(lies_s);
    }
    told.publish();
  }

  /// Of `amount`, so long after the lies have begun.
  double share(double lies_s) {
    using enum Parameters::Lie;
    ++told_;
    if (parameters_.lie == drift) return lies_s;
    if (parameters_.lie == jump) return told_ % 200 == 0 ? 1 : 0;
    if (parameters_.lie == to_and_fro) return told_ % 2 == 0 ? 1 : 0;
    return 1;
  }

  static constexpr std::size_t kLate = 100;  // samples: 0.1 s at 1 kHz
  Parameters parameters_;
  Ports ports_;
  std::optional<Time> start_;
  std::deque<msg::JointState> past_;  // the last one before a lie, or so many that are late
  std::size_t told_ = 0;
  bool stop_asked_ = false;
};

}  // namespace armature::test::lying_sensor

ARMATURE_PLUGIN(armature::test::lying_sensor::LyingSensor);
