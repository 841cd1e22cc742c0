// SPDX-License-Identifier: Apache-2.0
#include "replay/recorded_topics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "armature/config/problems.hpp"
#include "armature/values/monotonic_now.hpp"
#include "replay/recorded_qos.hpp"
#include "watch/outsider.hpp"

namespace armature {
namespace {

constexpr Duration kRest = seconds(0.1);           // where nothing is due
constexpr Duration kShortestStep = seconds(0.01);  // what is due sooner is handed on together
constexpr Duration kLongestStep = seconds(0.05);   // so often at least the time is told
constexpr Duration kLongestWork = seconds(0.05);   // at a time: others are served between

/// How many of the last messages of a topic say what is so now.
std::size_t kept_of(const McapChannel& channel) {
  constexpr std::size_t kLatched = 100;
  return settings(replayed_profile(channel)).transient_local ? kLatched : 1;
}

std::string type_of(const McapChannel& channel, const McapReader& reader) {
  const auto schema = reader.schemas().find(channel.schema_id);
  return schema == reader.schemas().end() ? "" : schema->second.name;
}

}  // namespace

RecordedTopics::RecordedTopics(const std::filesystem::path& file, const Options& options)
    : reader_{file}, copies_{file}, loops_{options.loop}, speed_{options.rate} {
  read_all();
  add_topics();
  if (chunks_.empty()) {
    throw std::runtime_error(fmt::format("{} has no messages", config::in_quotes(file.string())));
  }
  start_ = first_ + options.from;
  if (start_ > last_) {
    throw std::runtime_error(fmt::format("{} is {:g} s long: nothing is there from {:g} s on",
                                         config::in_quotes(file.string()),
                                         to_seconds(last_ - first_), to_seconds(options.from)));
  }
  jump(start_);
}

void RecordedTopics::read_all() {
  while (const auto message = read()) {
    const bool is_first = chunks_.empty();
    const Time time = message->log_time;
    first_ = is_first ? time : std::min(first_, time);
    last_ = is_first ? time : std::max(last_, time);
    if (is_first || chunks_.back().at != reader_.chunk())
      chunks_.push_back({.at = reader_.chunk()});
    chunks_.back().last = last_;
    ++chunks_.back().messages;
    chunks_.back().topics.insert(message->channel->topic);
  }
  problems_ = reader_.problems();
  for (const auto& [id, channel] : reader_.channels()) {
    if (!is_of_another_type(channel)) continue;
    problems_.push_back(
        fmt::format("{} has messages of two types: it is shown as {}, and those of {} are not",
                    config::in_quotes(channel.topic), config::in_quotes(types_.at(channel.topic)),
                    config::in_quotes(type_of(channel, reader_))));
  }
}

std::optional<McapMessage> RecordedTopics::read() {
  std::optional<McapMessage> message;
  do {
    message = reader_.next();
  } while (message && (copies_.has(*message) || is_of_another_type(*message->channel)));
  return message;
}

bool RecordedTopics::is_of_another_type(const McapChannel& channel) {
  const auto [place, is_new] = is_of_another_type_.try_emplace(channel.id, false);
  if (is_new) {
    const std::string type = type_of(channel, reader_);
    place->second = types_.try_emplace(channel.topic, type).first->second != type;
  }
  return place->second;
}

void RecordedTopics::add_topics() {
  for (const auto& [id, channel] : reader_.channels()) {
    const auto schema = reader_.schemas().find(channel.schema_id);
    const bool is_known = channel.message_encoding == "cdr" && schema != reader_.schemas().end() &&
                          schema->second.encoding == "ros2msg";
    if (!is_known || is_of_another_type(channel)) continue;
    topics_.try_emplace(
        channel.topic,
        RecordedTopic{.topic = {.name = channel.topic, .type = {}, .keeps = kept_of(channel)},
                      .schema = {.name = schema->second.name, .text = schema->second.data}});
  }
}

std::vector<TopicSource::Topic> RecordedTopics::topics() const {
  std::vector<Topic> topics;
  for (const auto& [name, recorded] : topics_) topics.push_back(recorded.topic);
  return topics;
}

TopicSource::Schema RecordedTopics::schema_of(const Topic& topic) const {
  return topics_.at(topic.name).schema;
}

bool RecordedTopics::watch(const std::string& name, OnMessage on_message) {
  watched_[name] = std::move(on_message);
  if (!std::exchange(begun_, true)) {
    status_ = Status::playing;
    since_ = monotonic_now();
  }
  tell_past({name}, told_);
  if (next_) find_again();
  return true;
}

void RecordedTopics::find_again() {
  const std::uint64_t of_chunk = next_of_chunk_;
  reader_.go_to(std::exchange(next_chunk_, 0));
  do {
    read_next();
  } while (next_ && next_of_chunk_ < of_chunk);
}

void RecordedTopics::unwatch(const std::string& name) { watched_.erase(name); }

void RecordedTopics::tell_past(const std::set<std::string>& names, Time time) {
  std::map<std::string, Past> past;
  for (const std::string& name : names) past[name].wanted = topics_.at(name).topic.keeps;
  const auto later = std::ranges::upper_bound(chunks_, time, {}, &Chunk::last);
  auto chunk = std::make_reverse_iterator(later == chunks_.end() ? later : std::next(later));
  for (; chunk != chunks_.rend(); ++chunk) {
    const bool is_wanted = std::ranges::any_of(past, [&](const auto& entry) {
      return entry.second.messages.size() < entry.second.wanted &&
             chunk->topics.contains(entry.first);
    });
    if (is_wanted) add_past(*chunk, time, past);
  }
  for (const auto& [name, of_topic] : past) {
    for (const Past::Message& message : of_topic.messages) {
      hand_on(name, {.time = message.time, .cdr = message.cdr});
    }
  }
}

void RecordedTopics::add_past(const Chunk& chunk, Time time, std::map<std::string, Past>& past) {
  std::map<std::string, std::deque<Past::Message>> found;
  reader_.go_to(chunk.at);
  for (std::uint64_t i = 0; i < chunk.messages; ++i) {
    const auto message = read();
    if (!message) break;
    const auto wanted = past.find(message->channel->topic);
    if (wanted == past.end() || message->log_time > time) continue;
    auto& of_topic = found[wanted->first];
    of_topic.push_back({message->log_time, {message->data.begin(), message->data.end()}});
    if (of_topic.size() > wanted->second.wanted) of_topic.pop_front();
  }
  for (auto& [name, messages] : found) {
    Past& of_topic = past.at(name);
    while (!messages.empty() && of_topic.messages.size() < of_topic.wanted) {
      of_topic.messages.push_front(std::move(messages.back()));
      messages.pop_back();
    }
  }
}

void RecordedTopics::hand_on(const std::string& name, const Message& message) const {
  const auto watched = watched_.find(name);
  if (watched != watched_.end()) watched->second(message);
}

void RecordedTopics::read_next() {
  // Where no message follows the reader would check the sum of the whole file, every time.
  const Chunk& end = chunks_.back();
  const bool is_last = next_chunk_ == end.at && next_of_chunk_ + 1 == end.messages;
  next_ = is_last ? std::nullopt : read();
  if (!next_) return;
  next_of_chunk_ = reader_.chunk() == next_chunk_ ? next_of_chunk_ + 1 : 0;
  next_chunk_ = reader_.chunk();
}

void RecordedTopics::find_next(Time time) {
  const auto chunk = std::ranges::upper_bound(chunks_, time, {}, &Chunk::last);
  next_.reset();
  if (chunk == chunks_.end()) return;
  reader_.go_to(chunk->at);
  next_chunk_ = 0;
  do {
    read_next();
  } while (next_ && next_->log_time <= time);
}

void RecordedTopics::jump(Time time) {
  at_ = told_ = time;
  since_ = monotonic_now();
  std::set<std::string> names;
  for (const auto& [name, on_message] : watched_) names.insert(name);
  tell_past(names, time);
  find_next(time);
}

Time RecordedTopics::now() const {
  if (status_ != Status::playing) return at_;
  const double passed_s = to_seconds(monotonic_now() - since_) * static_cast<double>(speed_);
  return std::min(at_ + seconds(passed_s), last_);
}

void RecordedTopics::settle() {
  at_ = now();
  since_ = monotonic_now();
}

Playback::State RecordedTopics::state() const {
  return {.status = status_, .at = now(), .speed = speed_};
}

bool RecordedTopics::request(const Request& request) {
  begun_ = true;
  settle();
  if (std::isfinite(request.speed) && request.speed > 0) speed_ = request.speed;
  const bool begins_again = request.plays && status_ == Status::ended && !request.seek;
  const bool jumps = request.seek.has_value() || begins_again;
  if (jumps) jump(std::clamp(request.seek.value_or(first_), first_, last_));
  if (request.plays) {
    status_ = Status::playing;
  } else if (jumps || status_ != Status::ended) {
    status_ = Status::paused;
  }
  return jumps;
}

Playback::Advance RecordedTopics::advance() {
  if (status_ == Status::ended && loops_) {
    jump(start_);
    status_ = Status::playing;
    return {.next = kShortestStep, .jumped = true};
  }
  if (status_ != Status::playing) return {.next = kRest};
  const Time began = monotonic_now(), now = this->now();
  while (next_ && next_->log_time <= now) {
    hand_on(next_->channel->topic, {.time = next_->log_time, .cdr = next_->data});
    read_next();
    if (next_ && monotonic_now() - began > kLongestWork) {  // it cannot go that fast
      at_ = told_ = std::min(next_->log_time, now);
      since_ = monotonic_now();
      return {};
    }
  }
  told_ = now;
  if (!next_ && now >= last_) {
    at_ = last_;
    status_ = Status::ended;
    return {};
  }
  const double left_s = to_seconds((next_ ? next_->log_time : last_) - now);
  return {.next = std::clamp(seconds(left_s / static_cast<double>(speed_)), kShortestStep,
                             kLongestStep)};
}

}  // namespace armature
