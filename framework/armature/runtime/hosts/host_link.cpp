// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/hosts/host_link.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <utility>

#include "armature/messages/std_msgs.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "armature/values/monotonic_now.hpp"

namespace armature {
namespace {

constexpr Duration kTellEvery = seconds(0.1);
constexpr std::size_t kMostWaiting = 100;  // messages that nobody has taken
constexpr std::string_view kLines = "lines ", kAsk = "ask ", kTold = "told ";

TopicSpec spec(const HostLinkEnd& end, bool to_main) {
  return {.name = fmt::format("rt/{}/hosts/{}/{}", end.deployment, end.host,
                              to_main ? "to_main" : "from_main"),
          .type = &message_type<msg::String>(),
          .qos = QosProfile::state};
}

}  // namespace

/// What DDS threads share with the thread of the link.
class HostLink::Inbox {
 public:
  Inbox(Transport& transport, const HostLinkEnd& end, const Clock& clock)
      : end_{end}, clock_{clock}, topic_{spec(end, !end.of_main), kMostWaiting} {
    auto writer = transport.advertise(topic_.spec());
    if (!writer) throw PluginError("cannot write to other hosts: " + writer.error().text);
    topic_.attach(std::move(*writer));
  }

  /// On a DDS thread.
  void deliver(const SampleRef& sample) {
    const std::string& text = static_cast<const msg::String*>(sample.message())->data_();
    const std::string_view view{text};
    if (end_.of_main && view.starts_with(kAsk)) {
      tell(fmt::format("{}{} {}", kTold, view.substr(kAsk.size()), clock_.now().ns));
    } else if (!end_.of_main && view.starts_with(kTold)) {
      take_answer(text);
    } else if (view.starts_with(kLines)) {
      const std::scoped_lock lock{mutex_};
      if (messages_.size() < kMostWaiting) messages_.emplace_back(view.substr(kLines.size()));
    }
  }

  void tell(const std::string& text) {
    const std::scoped_lock lock{telling_};
    SampleRef sample = topic_.loan();
    static_cast<msg::String*>(sample.mutable_message())->data_() = text;
    topic_.publish(std::move(sample), clock_.now());
  }

  std::vector<std::string> take_messages() {
    const std::scoped_lock lock{mutex_};
    return std::exchange(messages_, {});
  }

  ClockOffset offset() const {
    const std::scoped_lock lock{mutex_};
    return offset_;
  }

 private:
  /// "told ID ASKED TOLD"; of another agent of the same host nothing is believed.
  void take_answer(const std::string& text) {
    const Time now = clock_.now();
    long long asked = 0, told = 0;
    char id[64] = {};
    if (std::sscanf(text.c_str(), "told %63s %lld %lld", id, &asked, &told) != 3) return;
    const std::scoped_lock lock{mutex_};
    if (end_.id == id) offset_.add(Time{asked}, Time{told}, now);
  }

  const HostLinkEnd end_;
  const Clock& clock_;
  std::mutex telling_;
  Topic topic_;
  mutable std::mutex mutex_;  // guards what follows
  std::vector<std::string> messages_;
  ClockOffset offset_;
};

HostLink::HostLink(Transport& transport, HostLinkEnd end, const Clock& clock)
    : end_{std::move(end)},
      clock_{clock},
      lines_{end_.id},
      inbox_{std::make_unique<Inbox>(transport, end_, clock)} {
  auto reader = transport.subscribe(spec(end_, end_.of_main), false,
                                    [this](const SampleRef& sample) { inbox_->deliver(sample); });
  if (!reader) throw PluginError("cannot hear other hosts: " + reader.error().text);
  reader_ = std::move(*reader);
}

HostLink::~HostLink() = default;

bool HostLink::lost() const {
  return !other().empty() && monotonic_now() - lines_.heard() > kSilence;
}

void HostLink::turn_away() {
  lines_.turn_away();
  received_.clear();
}

void HostLink::send(std::string_view process, std::string_view line) {
  lines_.send(fmt::format("{} {}", process, line));
  to_be_told_ = true;
}

std::optional<std::string> HostLink::receive(std::string_view process) {
  const auto lines = received_.find(process);
  if (lines == received_.end() || lines->second.empty()) return std::nullopt;
  std::string line = std::move(lines->second.front());
  lines->second.pop_front();
  return line;
}

void HostLink::update() {
  const Time now = monotonic_now();
  for (const std::string& message : inbox_->take_messages()) lines_.take(message, now);
  while (const auto line = lines_.receive()) {
    const std::size_t space = line->find(' ');
    if (space == std::string::npos) continue;
    received_[line->substr(0, space)].push_back(line->substr(space + 1));
    to_be_told_ = true;  // that it has arrived
  }
  // The main process speaks when it is spoken to.
  const bool may_speak = !end_.of_main || !other().empty();
  if (!may_speak || (!to_be_told_ && now - told_ < kTellEvery)) return;
  inbox_->tell(std::string{kLines} + lines_.message());
  told_ = now;
  to_be_told_ = false;
}

void HostLink::ask_clock() { inbox_->tell(fmt::format("{}{} {}", kAsk, end_.id, clock_.now().ns)); }

std::optional<ClockOffset::Estimate> HostLink::clock_ahead() const {
  return inbox_->offset().estimate();
}

std::size_t HostLink::clock_answers() const { return inbox_->offset().answers(); }

}  // namespace armature
