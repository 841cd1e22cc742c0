// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/values/chance.hpp"
#include "test_any_node_parameters.hpp"

namespace armature::test::any_node {
namespace {

constexpr std::array kPorts{"state", "aged", "sensor", "command", "latched", "reply", "log"};

}  // namespace

/// Its numbers follow from every sample that it was shown, from when it was, and from chance.
class AnyNode final : public Component {
 public:
  explicit AnyNode(Setup& setup)
      : Component{setup}, parameters_{Parameters::read(setup.params())}, chance_{setup.seed()} {
    for (std::size_t i = 0; i < kPorts.size(); ++i) {
      inputs_[i] = setup.input<msg::JointState>(kPorts[i]);
      outputs_[i] = setup.output<msg::JointState>(fmt::format("to_{}", kPorts[i]));
    }
    if (parameters_.rate > 0) setup.activate_every(seconds(1 / parameters_.rate));
  }

  void step(Time now) override {
    if (++steps_ == parameters_.fails_after) throw std::runtime_error{"so it was to be"};
    for (const auto& input : inputs_) {
      mix(input.fresh() ? 1 : 2);
      for (std::size_t i = 0; i < input.size(); ++i) {
        mix(to_seconds(now - stamp_of(input[i].header_().stamp_())));
        for (const double number : input[i].position_()) mix(number);
      }
    }
    for (auto& output : outputs_) send(output, now);
  }
  void begin_stop(Time now) override { send(outputs_[0], now); }
  void stop(Time now) override { send(outputs_[1], now); }

 private:
  void mix(double number) { state_ = std::sin(parameters_.gain * (3 * state_ + number)); }

  void send(Output<msg::JointState>& output, Time now) {
    if (!output.has_subscribers()) mix(3);
    if (chance_.share() < parameters_.silence) return;
    for (auto left = chance_.bits() % (parameters_.burst + 1); left > 0; --left) {
      auto loan = output.loan();
      set_stamp(loan->header_().stamp_(), now);
      loan->header_().frame_id_() = fmt::format("{}", steps_);
      loan->position_().clear();
      for (auto more = chance_.bits() % parameters_.length + 1; more > 0; --more) {
        mix(chance_.share());
        loan->position_().push_back(state_);
      }
      loan.publish();
    }
  }

  Parameters parameters_;
  Chance chance_;
  std::array<Input<msg::JointState>, kPorts.size()> inputs_;
  std::array<Output<msg::JointState>, kPorts.size()> outputs_;
  double state_ = 0.5;
  std::uint64_t steps_ = 0;
};

}  // namespace armature::test::any_node

ARMATURE_PLUGIN(armature::test::any_node::AnyNode);
