// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/execution/log_publisher.hpp"

#include <mutex>

#include "armature/messages/stamp.hpp"
#include "armature/runtime/component/setup.hpp"

namespace armature {
namespace {

constexpr Duration kPeriod = seconds(0.1);

constexpr const char* kLogManifest = R"(
armature_plugin: 1
id: runtime/log_publisher
kind: component
doc: Publishes what this process tells the operator.
out:
  log: {type: rcl_interfaces/Log, topic: /rosout, qos: log, shared: true, doc: "One message per line"}
)";

std::uint8_t level_of(StatusReporter::State state) {
  constexpr std::uint8_t kInfo = 20, kWarning = 30, kError = 40;
  switch (state) {
    case StatusReporter::State::ok: return kInfo;
    case StatusReporter::State::degraded: return kWarning;
    default: return kError;
  }
}

}  // namespace

void LogQueue::put(Time at, std::string_view who, std::string_view text,
                   StatusReporter::State state) {
  const std::scoped_lock lock{mutex_};
  if (count_ == kCapacity) {
    oldest_ = (oldest_ + 1) % kCapacity;
    --count_;
  }
  lines_[(oldest_ + count_) % kCapacity] = {.at = at, .state = state, .who = who, .text = text};
  ++count_;
}

bool LogQueue::take(Line& line) {
  const std::scoped_lock lock{mutex_};
  if (count_ == 0) return false;
  line = lines_[oldest_];
  oldest_ = (oldest_ + 1) % kCapacity;
  --count_;
  return true;
}

const PluginManifest& LogPublisher::manifest() {
  static const PluginManifest manifest = parse_own_manifest(kLogManifest);
  return manifest;
}

LogPublisher::LogPublisher(Setup& setup, const std::string& deployment, LogQueue& queue)
    : Component{setup},
      prefix_{deployment + "."},
      queue_{queue},
      log_{setup.output<msg::Log>("log")} {
  setup.activate_every(kPeriod);
}

void LogPublisher::step(Time) {
  while (queue_.take(line_)) {
    auto message = log_.loan();
    set_stamp(message->stamp_(), line_.at);
    message->level_(level_of(line_.state));
    message->name_().assign(prefix_).append(line_.who.view());
    message->msg_().assign(line_.text.view());
    message->file_().clear();
    message->function_().clear();
    message->line_(0);
    message.publish();
  }
}

}  // namespace armature
