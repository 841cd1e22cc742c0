// SPDX-License-Identifier: Apache-2.0
#include "operator/task_link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "armature/messages/header.hpp"
#include "armature/values/monotonic_now.hpp"
#include "watch/outsider.hpp"

namespace armature {

TaskLink::TaskLink(PluginRegistry& plugins, TaskTopics topics, const NetworkOptions& network)
    : topics_{std::move(topics)}, joined_{monotonic_now()} {
  const TransportOptions options{
      .network = network,
      .deployment = "armature operator",
      .fingerprint = {},
      .on_event =
          [](const TransportEvent& event) { fmt::print(stderr, "armature: {}\n", event.text); },
      .now = [this] { return clock_.now(); }};
  auto transport = plugins.make<Transport>("transport/fast_dds", options);
  if (!transport) throw PluginError("cannot join DDS: " + transport.error().text);
  transport_ = std::move(*transport);
  const TopicSpec command{.name = "rt" + topics_.command,
                          .type = &message_type<msg::OperatorCommand>(),
                          .qos = QosProfile::command};
  auto writer = transport_->advertise(command);
  if (!writer) throw PluginError("cannot write " + topics_.command + ": " + writer.error().text);
  constexpr std::size_t kSamples = 16;
  command_ = std::make_unique<Topic>(command, kSamples);
  command_->attach(std::move(*writer));
  auto observer =
      plugins.make<DdsObserver>("observer/fast_dds", ObserverOptions{.network = network});
  if (!observer) throw PluginError("cannot join DDS: " + observer.error().text);
  observer_ = std::move(*observer);
}

void TaskLink::look() {
  std::vector<WriterId> own;
  tasks_.clear();
  for (const ObservedTopic& topic : observer_->topics()) {
    if (topic.name != "rt" + topics_.state) continue;
    for (const ObservedEndpoint& endpoint : topic.endpoints) {
      if (!endpoint.writes || !is_own(endpoint)) continue;
      own.push_back(endpoint.guid);
      tasks_.push_back(endpoint.owner);
    }
  }
  const bool found = !own.empty();
  {
    const std::scoped_lock lock{mutex_};
    own_ = std::move(own);
    std::erase_if(states_, [&](const auto& entry) {
      return std::ranges::find(own_, entry.first) == own_.end();
    });
  }
  if (watched_ || !found) return;
  const auto watching = observer_->watch(topics_.state, Duration{0},
                                         [this](const ObservedSample& sample) { keep(sample); });
  watched_ = watching.has_value();
}

/// Whether a writer says that it is the task; who else it is, is named.
bool TaskLink::is_own(const ObservedEndpoint& writer) {
  const MessageType& type = message_type<msg::TaskState>();
  if (writer.deployment != topics_.deployment) {
    name_once(writer.owner, fmt::format("writes '{}', too, and is no part of deployment '{}': what "
                                        "it tells is not taken",
                                        topics_.state, topics_.deployment));
    return false;
  }
  const bool same_layout = writer.layout == 0 || writer.layout == type.layout;
  if (writer.type == type.dds_name && same_layout) return true;
  name_once(writer.owner,
            fmt::format("writes '{}' as another type than this program knows ({}): build both from "
                        "the same idl/",
                        topics_.state, type.dds_name));
  return false;
}

void TaskLink::name_once(const std::string& who, const std::string& what) {
  if (!named_.insert(who).second) return;
  fmt::print(stderr, "armature: a writer of {} {}\n", who, what);
}

void TaskLink::keep(const ObservedSample& sample) {
  if (!sample.writer) return;
  const auto state = decoded<msg::TaskState>(sample);
  const std::scoped_lock lock{mutex_};
  const bool own = std::ranges::find(own_, sample.writer->guid) != own_.end();
  if (!own || !state) return;
  const Time stamp = stamp_of(state->header_().stamp_());
  states_[sample.writer->guid] = {*state, stamp == Time{} ? Duration{0} : stamp - clock_.now()};
  if (said_ && state->answered_() == *said_) answer_ = state->answer_();
}

std::optional<std::string> TaskLink::answer() const {
  const std::scoped_lock lock{mutex_};
  return answer_;
}

/// With `mutex_` held.
const TaskLink::Told* TaskLink::told_last() const {
  if (own_.size() != 1) return nullptr;
  const auto found = states_.find(own_.front());
  return found == states_.end() ? nullptr : &found->second;
}

std::optional<msg::TaskState> TaskLink::state() const {
  const std::scoped_lock lock{mutex_};
  const Told* told = told_last();
  return told ? std::optional{told->state} : std::nullopt;
}

bool TaskLink::knows_all() const { return monotonic_now() - joined_ > kDiscovery; }

void TaskLink::say(std::uint64_t id, const std::string& word, const std::string& step) {
  Duration clock_ahead{0};
  {
    const std::scoped_lock lock{mutex_};
    if (const Told* told = told_last()) clock_ahead = told->clock_ahead;
    if (std::exchange(said_, id) != id) answer_.reset();
  }
  SampleRef sample = command_->loan();
  auto& message = *static_cast<msg::OperatorCommand*>(sample.mutable_message());
  write_header(message.header_(), clock_.now() + clock_ahead);
  message.command_id_(id);
  message.command_() = word;
  message.step_() = step;
  command_->publish(std::move(sample), clock_.now());
}

}  // namespace armature
