// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "armature/messages/rcl_interfaces.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/ports.hpp"
#include "armature/runtime/component/status_reporter.hpp"
#include "armature/runtime/execution/clock.hpp"
#include "armature/runtime/plugins/plugin_manifest.hpp"
#include "armature/values/inline_text.hpp"
#include "armature/values/real_time_mutex.hpp"

namespace armature ARMATURE_EXPORT {

/// What the operator was told and nobody has published yet: the newest lines, as many as a late
/// joiner gets.
class LogQueue {
 public:
  struct Line {
    Time at;
    StatusReporter::State state = StatusReporter::State::ok;
    InlineText<64> who;
    InlineText<StatusReporter::kMaxText> text;
  };
  static constexpr std::size_t kCapacity = 100;

  LogQueue() : lines_(kCapacity) {}
  /// Real-time safe, any thread. A full queue forgets its oldest line.
  void put(Time at, std::string_view who, std::string_view text, StatusReporter::State state);
  /// Takes the oldest line; false when there is none.
  bool take(Line& line);

 private:
  RealTimeMutex mutex_;
  std::vector<Line> lines_;  // a ring
  std::size_t oldest_ = 0, count_ = 0;
};

/// The runtime's own component in every process: publishes what the operator is told as
/// rcl_interfaces/Log on /rosout, where ROS tools look for it.
class LogPublisher final : public Component {
 public:
  /// Whoever speaks is called "<deployment>.<component>". `queue` outlives it.
  LogPublisher(Setup& setup, const std::string& deployment, LogQueue& queue);

  static const PluginManifest& manifest();
  void step(Time now) override;
  void stop(Time now) override { step(now); }

 private:
  const std::string prefix_;
  LogQueue& queue_;
  LogQueue::Line line_;
  Output<msg::Log> log_;
};

}  // namespace armature
