// SPDX-License-Identifier: Apache-2.0
// A Setup for tests that drive components and schedulers without a deployment file.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/execution/component_runner.hpp"

namespace armature ARMATURE_EXPORT {

/// Grants every port that is asked for; what is published reaches its readers at once. Outlives the
/// component.
class FakeSetup final : public Setup, public Delivery {
 public:
  explicit FakeSetup(ComponentRunner& runner) : runner_{runner} {}

  const std::string& name() const override { return runner_.name(); }
  std::string_view unit() const override { return kMainUnit; }
  const Params& params() const override { return params_; }
  std::uint64_t seed() const override { return 1; }
  const config::Node& document(std::string_view) override {
    throw std::logic_error("no documents");
  }
  bool has_document(std::string_view) const override { return false; }
  void activate_every(Duration period) override { runner_.set_period(period); }
  void deliver_after(Duration latency) override { runner_.set_latency(latency); }
  bool is_written(std::string_view) const override { return true; }
  std::optional<NetworkOptions> network() const override { return std::nullopt; }
  Duration stop_within() const override { return seconds(3); }
  bool is_filled(std::string_view) const override { return false; }
  const PluginManifest& slot_manifest(std::string_view) const override {
    throw std::logic_error("no slots");
  }
  std::shared_ptr<StatusReporter> reporter() override { return runner_.reporter(); }
  void publish(Topic& topic, SampleRef sample) override { topic.send(std::move(sample), {}); }

  /// The topic of a port that has been claimed.
  Topic& topic(const std::string& port) { return *topics_.at(port); }

 protected:
  InputPort& claim_input(std::string_view port, const MessageType& type) override {
    InputPort& input = runner_.inbox().add({.name = std::string{port}}, type);
    make_topic(port, type).connect(input);
    return input;
  }
  OutputPort& claim_output(std::string_view port, const MessageType& type) override {
    OutputPort& output = runner_.outputs().emplace_back(
        PortSpec{.name = std::string{port}}, make_topic(port, type), *this, runner_.inbox());
    output.open();  // it is stepped without a runner, too
    return output;
  }
  SlotPlugin slot_plugin(std::string_view, std::string_view) override {
    throw std::logic_error("no slots");
  }
  void keep_slot(std::unique_ptr<SlotPlace> place) override {
    runner_.slots().push_back(std::move(place));
  }
  void keep_thread(std::unique_ptr<DriverThread> thread) override {
    runner_.add_thread(std::move(thread));
  }

 private:
  Topic& make_topic(std::string_view port, const MessageType& type) {
    auto& topic = topics_[std::string{port}];
    topic = std::make_unique<Topic>(TopicSpec{.name = std::string{port}, .type = &type}, 2);
    return *topic;
  }

  ComponentRunner& runner_;
  Params params_;
  std::map<std::string, std::unique_ptr<Topic>> topics_;
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

inline std::unique_ptr<ComponentRunner> make_runner(const std::string& name, int place,
                                                    std::function<void(Time)> step) {
  auto runner =
      std::make_unique<ComponentRunner>(name, "test/lambda", place, StatusReporter::Sink{});
  FakeSetup setup{*runner};
  runner->install(nullptr, std::make_unique<LambdaComponent>(setup, std::move(step)));
  return runner;
}

}  // namespace armature
