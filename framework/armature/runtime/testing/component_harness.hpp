// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "armature/config/document.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/deployment/component_setup.hpp"
#include "armature/runtime/deployment_file/component_config.hpp"
#include "armature/runtime/execution/clock.hpp"

namespace armature ARMATURE_EXPORT {

/// What a component tells of a run, by key: for tests.
struct Figures final : Summary {
  std::map<std::string, double> metrics;
  std::map<std::string, std::vector<double>> lists;
  std::map<std::string, std::string> texts, unmeasured, inapplicable;
  std::string status, reason;  // of a scenario that failed

  void metric(std::string key, std::string, double value) override { metrics[key] = value; }
  void series(std::string key, std::string, std::vector<double> values) override {
    lists[key] = std::move(values);
  }
  void text(std::string key, std::string, std::string value) override { texts[key] = value; }
  void not_measured(std::string key, std::string, std::string why) override {
    unmeasured[key] = std::move(why);
  }
  void does_not_apply(std::string key, std::string, std::string why) override {
    inapplicable[key] = std::move(why);
  }
  void failed(std::string what, std::string why) override {
    status = std::move(what);
    reason = std::move(why);
  }
};

inline Figures figures_of(const Component& component) {
  Figures figures;
  component.summarize(figures);
  return figures;
}

/// One component on a bench, for tests: made from its plugin.yaml and library as a deployment makes
/// it, its topics in memory only, and activated by hand.
///
///     ComponentHarness arm{plugins, {.component = "{plugin: arm/simulated}", .robot = lamp}};
///     arm.send("servo_jp", command);
///     arm.step(0.001);
///     EXPECT_EQ(arm.take<msg::JointState>("measured_js").size(), 1u);
class ComponentHarness final : private Delivery {
 public:
  struct Options {
    std::string component;  // its entry in a deployment: "{plugin: ik/numeric, params: {...}}"
    std::optional<config::Node> robot, rig;  // the documents it is bound to
    std::string unit{kMainUnit};             // which one, of a component that is several
    std::vector<std::string> written = {};   // optional inputs that some other component writes
  };

  /// Throws config::ConfigError, PluginError, or what the component's own constructor throws;
  /// std::logic_error when it does not claim exactly the ports of its plugin.yaml. `plugins`
  /// outlives the bench.
  ComponentHarness(PluginRegistry& plugins, const Options& options);
  ~ComponentHarness() override;
  ComponentHarness(const ComponentHarness&) = delete;
  ComponentHarness& operator=(const ComponentHarness&) = delete;

  /// Hands `message` to the input, as if it had just been published.
  template <class Message>
  void send(std::string_view input, const Message& message) {
    Topic& topic = topic_of(config_.inputs, input, message_type<Message>());
    SampleRef sample = topic.loan();
    *static_cast<Message*>(sample.mutable_message()) = message;
    topic.publish(std::move(sample), now_.now());
  }
  /// The same with an encoded message of the port's type; false when `cdr` is none.
  bool send_encoded(std::string_view input, std::span<const std::byte> cdr);
  const std::vector<PortBinding>& inputs() const { return config_.inputs; }
  /// True when a trigger input has asked for an activation since the last one.
  bool triggered() const { return triggered_; }
  /// Samples that full queues have lost.
  std::uint64_t dropped() const { return runner_->dropped(); }
  /// One activation at `now_s`; an exception out of the component is thrown on as runtime_error.
  /// The first one starts its driver threads.
  void step(double now_s);
  /// Tells the component at `now_s` that the run is stopping; steps go on. An exception as above.
  void begin_stop(double now_s);
  /// Where its plugin `name` sits; a successor that is offered sits there from the next step on.
  SlotPlace& slot(std::string_view name);
  /// What the component answered last to whether it is at rest; false before `begin_stop`.
  bool stopped() const { return runner_->stopped(); }
  /// Everything the output published since the last call, oldest first.
  template <class Message>
  std::vector<Message> take(std::string_view output) {
    topic_of(config_.outputs, output, message_type<Message>());
    std::vector<Message> messages;
    for (const SampleRef& sample : std::exchange(taps_[std::string{output}].samples, {})) {
      messages.push_back(*static_cast<const Message*>(sample.message()));
    }
    return messages;
  }

  StatusReporter::Status status() const { return runner_->status(); }
  /// What it told the operator.
  const std::vector<std::string>& lines() const { return lines_; }
  const std::optional<Duration>& period() const { return runner_->period(); }
  Component& component() { return runner_->component(); }
  /// What it tells of the run so far.
  Figures figures() { return figures_of(component()); }

 private:
  struct Tap final : Subscriber {
    std::vector<SampleRef> samples;
    void deliver(const SampleRef& sample) override { samples.push_back(sample); }
  };

  void publish(Topic& topic, SampleRef sample) override {
    topic.send(std::move(sample), now_.now());
  }
  void read(const PluginRegistry& plugins, const Options& options);
  Topic& topic_for(const PortBinding& port, const MessageType& type);
  Topic& topic_of(const std::vector<PortBinding>& ports, std::string_view name,
                  const MessageType& type);

  DeploymentConfig deployment_;
  ComponentConfig config_;
  SimulatedClock now_;
  std::atomic<bool> triggered_{false};
  std::vector<std::string> lines_;
  std::map<std::string, std::unique_ptr<Topic>> topics_;  // by name; outlive their samples
  std::map<std::string, Tap> taps_;                       // by output
  std::unique_ptr<ComponentRunner> runner_;
};

/// Why such a component cannot be made, or "".
std::string refusal_of(PluginRegistry& plugins, const ComponentHarness::Options& options);

}  // namespace armature
