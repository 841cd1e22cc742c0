// SPDX-License-Identifier: Apache-2.0
// A Setup for tests that drive components and schedulers without a deployment file.
#pragma once

#include <stdexcept>

#include "armature/runtime/setup.hpp"
#include "armature/runtime/unit.hpp"

namespace armature {

class FakeSetup final : public Setup {
 public:
  explicit FakeSetup(Unit& unit) : unit_{unit} {}

  const std::string& name() const override { return unit_.name(); }
  const Params& params() const override { return params_; }
  std::uint64_t seed() const override { return 1; }
  const config::Node& document(std::string_view) override {
    throw std::logic_error("no documents");
  }
  void activate_every(Duration period) override { unit_.set_period(period); }
  std::shared_ptr<Voice> voice() override { return unit_.voice(); }

 protected:
  const InputPort& claim_input(std::string_view, const MessageType&) override {
    throw std::logic_error("no inputs");
  }
  OutputPort& claim_output(std::string_view, const MessageType&) override {
    throw std::logic_error("no outputs");
  }
  SlotPlugin slot_plugin(std::string_view, std::string_view, int) override {
    throw std::logic_error("no slots");
  }

 private:
  Unit& unit_;
  Params params_;
};

/// A component whose step is a function.
class LambdaComponent final : public Component {
 public:
  LambdaComponent(Setup& setup, std::function<void(Time)> step)
      : Component{setup}, step_{std::move(step)} {}
  void step(Time now) override { step_(now); }

 private:
  std::function<void(Time)> step_;
};

inline std::unique_ptr<Unit> make_unit(const std::string& name, int place,
                                       std::function<void(Time)> step) {
  auto unit = std::make_unique<Unit>(name, "test/lambda", place, Voice::Sink{});
  FakeSetup setup{*unit};
  unit->install({nullptr, std::make_unique<LambdaComponent>(setup, std::move(step))});
  return unit;
}

}  // namespace armature
