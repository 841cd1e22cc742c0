// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "armature/messages/armature_msgs.hpp"
#include "armature/runtime/component/activation_tap.hpp"
#include "armature/runtime/component/output_port.hpp"
#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/runtime/execution/clock.hpp"
#include "armature/runtime/execution/component_runner.hpp"
#include "replay/recorded_run.hpp"

namespace armature {

/// A message that a component published in a replay.
struct ReplayedMessage {
  std::uint32_t writer = 0;  // as the recording numbers them; 0: of an output that it does not have
  std::string topic;
  const MessageType* type = nullptr;
  std::vector<std::byte> cdr;
};

/// One component of a recorded run, constructed anew, whose calls are repeated: it is shown the
/// samples and the time that the recording says, and gets the answers that it got then.
class ReplayedComponent final : private Delivery, private ActivationTap {
 public:
  /// Throws what the component's constructor throws. `deployment` and `plugins` outlive it.
  ReplayedComponent(const ComponentConfig& config, const DeploymentConfig& deployment,
                    PluginRegistry& plugins, const RecordedPorts& recorded);
  ~ReplayedComponent() override;
  ReplayedComponent(const ReplayedComponent&) = delete;
  ReplayedComponent& operator=(const ReplayedComponent&) = delete;

  /// Repeats a call. What it lacks of it: "its input 'image' is not in the recording", or nothing.
  std::optional<std::string> repeat(const msg::Activation& call, const RecordedRun& run);
  /// What the last call published, in its order.
  const std::vector<ReplayedMessage>& published() const { return published_; }
  /// The reason of an exception that came out of it, or nothing.
  std::optional<std::string> failure() const;
  ComponentRunner& runner() { return *runner_; }

 private:
  /// An input as the recording numbers it; null: it has none of that name any more.
  struct Input {
    std::string name;
    InputPort* port = nullptr;
    std::unique_ptr<SamplePool> pool;
  };

  void construct(const ComponentConfig& config, const DeploymentConfig& deployment,
                 PluginRegistry& plugins);
  Topic& topic_for(const PortBinding& port, const MessageType& type);

  void publish(Topic& topic, SampleRef sample) override;
  void begin(ComponentCall, Time) override {}
  void end(std::string_view) override {}
  void read(int, std::span<const SampleRef>) override {}
  bool has_subscribers(bool truly) override;
  void published(const SampleRef&) override {}

  SimulatedClock clock_;
  std::map<std::string, std::unique_ptr<Topic>> topics_;
  std::vector<Input> inputs_;
  std::map<std::uint32_t, std::uint32_t> writers_;  // as recorded, by the number here
  std::unique_ptr<ComponentRunner> runner_;
  std::vector<bool> answers_;
  std::size_t next_answer_ = 0;
  std::vector<ReplayedMessage> published_;
};

}  // namespace armature
