// SPDX-License-Identifier: Apache-2.0
#include "armature/web/foxglove_bridge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>

#include "armature/values/json_text.hpp"
#include "armature/values/monotonic_now.hpp"
#include "armature/values/utf8.hpp"
#include "armature/web/foxglove_messages.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostKept = 16U << 20;  // of a topic, but for its newest message [byte]
constexpr std::string_view kWithPlayback = "foxglove.sdk.v1";
enum Level { kWarning = 1, kError = 2 };

std::string status(Level level, const std::string& text) {
  return json_text(Json{{"op", "status"}, {"level", level}, {"message", text}});
}

/// The beginning of what a client has said, as it is told back.
std::string beginning_of(std::string_view said) {
  constexpr std::size_t kMostCharacters = 80;
  std::string_view rest = said;
  for (std::size_t i = 0; i < kMostCharacters && !rest.empty(); ++i) {
    rest.remove_prefix(std::max<std::size_t>(first_character(rest).length, 1));
  }
  const std::string begin{said.substr(0, said.size() - rest.size())};
  return rest.empty() ? begin : begin + "...";
}

/// A time as it stands in JSON, where numbers have 53 bits.
Json json_of(Time time) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  return {{"sec", time.ns / kSecond}, {"nsec", time.ns % kSecond}};
}

/// How many levels of lists and objects a text of JSON has at most.
int depth_of(std::string_view text) {
  int depth = 0, deepest = 0;
  bool is_quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') is_quoted = !is_quoted;
    if (is_quoted) {
      if (c == '\\') ++i;  // what follows ends no text
      continue;
    }
    if (c == '[' || c == '{') deepest = std::max(deepest, ++depth);
    if (c == ']' || c == '}') --depth;
  }
  return deepest;
}

/// What a client has said. Throws std::invalid_argument unless it is a JSON object, and where it is
/// nested deeper than all that is said here: what writes or copies JSON calls itself at each level.
nlohmann::json object_of(std::string_view text) {
  constexpr int kDeepest = 16;
  if (depth_of(text) > kDeepest) throw std::invalid_argument("what was said is nested too deeply");
  // Without a callback, with which the library looks through a whole list for each of its objects.
  nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) throw std::invalid_argument("what was said is no JSON object");
  return json;
}

/// The id that a client has said. Throws std::invalid_argument unless it is a whole number of 32
/// bits.
std::uint32_t id_of(const nlohmann::json& said) {
  if (said.is_number_unsigned() &&
      said.get<std::uint64_t>() <= std::numeric_limits<std::uint32_t>::max()) {
    return said.get<std::uint32_t>();
  }
  const std::string what =
      said.is_primitive() ? beginning_of(json_text(said)) : fmt::format("an {}", said.type_name());
  throw std::invalid_argument("an id is a whole number from 0 to 4294967295, not " + what);
}

template <class Clients>
bool is_read(const Clients& clients, std::uint32_t channel) {
  return std::ranges::any_of(
      clients, [&](const auto& entry) { return entry.second.subscriptions.contains(channel); });
}

}  // namespace

FoxgloveBridge::FoxgloveBridge(TopicSource& topics, Options options)
    : topics_{topics},
      options_{std::move(options)},
      server_{std::move(options_.server), events()} {}

FoxgloveBridge::~FoxgloveBridge() {
  for (const auto& [id, channel] : channels_) {
    if (channel.is_watched) topics_.unwatch(channel.topic.name);
  }
}

WebServer::Events FoxgloveBridge::events() {
  return {.opened = [this](Client client, std::string_view protocol) { opened(client, protocol); },
          .closed = [this](Client client) { closed(client); },
          .said = [this](Client client, std::string_view text) { said(client, text); },
          .said_binary = [this](Client client,
                                std::string_view message) { said_binary(client, message); },
          .woken = [this] { forward(); },
          .refused = [this](const WebServer::Refusal& refusal) { tell_refusal(refusal); }};
}

void FoxgloveBridge::run(const std::function<bool()>& ends) {
  constexpr Duration kRound = seconds(0.1);
  Time next, next_play;
  auto status = Playback::Status::paused;
  while (!ends()) {
    const Time now = monotonic_now();
    if (now >= next) {
      look();
      tell_dropped();
      next = now + 2 * kRound;
    }
    Duration wait = kRound;
    if (Playback* playback = options_.playback) {
      // Serving a client returns sooner, and is no reason to play on, unless that has begun.
      if (now >= next_play || playback->state().status != status) next_play = now + play();
      status = playback->state().status;
      wait = std::clamp(next_play - now, Duration{0}, kRound);
    }
    server_.serve(wait);
  }
}

std::uint64_t FoxgloveBridge::dropped() const {
  std::uint64_t dropped = dropped_ + lost_;
  for (const auto& [client, subscriber] : clients_) dropped += server_.dropped(client);
  return dropped;
}

void FoxgloveBridge::opened(Client client, std::string_view protocol) {
  Subscriber& subscriber = clients_[client];
  Json info{{"op", "serverInfo"},
            {"name", "armature"},
            {"capabilities", Json::array()},
            {"metadata", Json::object()},
            {"sessionId", fmt::format("{}", monotonic_now().ns)}};
  if (const Playback* playback = options_.playback) {
    subscriber.controls = protocol == kWithPlayback;
    info["capabilities"].push_back("time");
    if (subscriber.controls) info["capabilities"].push_back("playbackControl");
    info["dataStartTime"] = json_of(playback->first());
    info["dataEndTime"] = json_of(playback->last());
  }
  server_.send(client, json_text(info));
  std::vector<const Channel*> all;
  for (const auto& [id, channel] : channels_) all.push_back(&channel);
  advertise(all, client);
  if (options_.playback) tell_playback(false);
}

void FoxgloveBridge::closed(Client client) {
  dropped_ += server_.dropped(client);
  std::vector<std::uint32_t> subscriptions;
  for (const auto& [subscription, channel] : clients_[client].channels) {
    subscriptions.push_back(subscription);
  }
  for (const std::uint32_t subscription : subscriptions) unsubscribe(client, subscription);
  clients_.erase(client);
}

void FoxgloveBridge::said(Client client, std::string_view text) {
  const auto refuse_with = [&](const std::string& why) { send_error(client, why); };
  try {
    const nlohmann::json json = object_of(text);
    const std::string op = json.at("op");
    if (op == "subscribe") {
      for (const auto& one : json.at("subscriptions")) {
        subscribe(client, id_of(one.at("id")), id_of(one.at("channelId")));
      }
    } else if (op == "unsubscribe") {
      for (const auto& subscription : json.at("subscriptionIds")) {
        unsubscribe(client, id_of(subscription));
      }
    } else {
      refuse_with(fmt::format("'{}' is not done here: a monitor only shows", beginning_of(op)));
    }
  } catch (const nlohmann::json::exception& error) {
    refuse_with(beginning_of(error.what()));
  } catch (const std::invalid_argument& error) {
    refuse_with(error.what());
  }
}

void FoxgloveBridge::said_binary(Client client, std::string_view message) {
  if (!clients_.at(client).controls) {
    return send_error(client, "a binary message is not taken here: a monitor only shows");
  }
  const auto control = read_playback_control(message);
  if (!control) return send_error(client, control.error().text);
  forward();  // what came before a jump is told before it
  if (options_.playback->request(control->request)) {
    tell_jump(client, control->id);
  } else {
    tell_playback(false, client, control->id);
  }
  forward();
  tell_time();
}

void FoxgloveBridge::subscribe(Client client, std::uint32_t subscription,
                               std::uint32_t channel_id) {
  Subscriber& subscriber = clients_.at(client);
  const auto channel = channels_.find(channel_id);
  if (channel == channels_.end()) {
    return send_error(client, fmt::format("there is no channel {}", channel_id));
  }
  if (subscriber.channels.contains(subscription)) {
    return send_error(client, fmt::format("subscription {} is used already", subscription));
  }
  if (const auto same = subscriber.subscriptions.find(channel_id);
      same != subscriber.subscriptions.end()) {
    return send_error(client, fmt::format("channel {} has the subscription {} already: a channel "
                                          "has one of each client",
                                          channel_id, same->second));
  }
  subscriber.channels[subscription] = channel_id;
  subscriber.subscriptions[channel_id] = subscription;
  if (!channel->second.is_watched) return watch(channel->second);
  for (const Message& message : channel->second.kept) send(client, subscription, message);
}

void FoxgloveBridge::unsubscribe(Client client, std::uint32_t subscription) {
  Subscriber& subscriber = clients_.at(client);
  const auto found = subscriber.channels.find(subscription);
  if (found == subscriber.channels.end()) return;
  const std::uint32_t channel = found->second;
  subscriber.channels.erase(found);
  subscriber.subscriptions.erase(channel);
  leave_alone(channel);
}

void FoxgloveBridge::leave_alone(std::uint32_t channel_id) {
  if (is_read(clients_, channel_id)) return;
  Channel& channel = channels_.at(channel_id);
  if (!std::exchange(channel.is_watched, false)) return;
  topics_.unwatch(channel.topic.name);
  channel.kept.clear();
}

void FoxgloveBridge::look() {
  std::set<std::uint32_t> there;
  std::vector<const Channel*> came;
  Json gone = Json::array();
  for (TopicSource::Topic& topic : topics_.topics()) {
    const auto known = by_topic_.find(topic.name);
    if (known != by_topic_.end() && there.contains(known->second)) continue;  // of two the first
    if (known != by_topic_.end() && channels_.at(known->second).topic.type != topic.type) {
      gone.push_back(known->second);
      forget(known->second);
    }
    const auto [place, is_new] = by_topic_.try_emplace(topic.name, last_channel_ + 1);
    there.insert(place->second);
    if (!is_new) {
      Channel& channel = channels_.at(place->second);
      channel.topic.keeps = topic.keeps;
      if (!channel.is_watched && is_read(clients_, channel.id)) watch(channel);
      continue;
    }
    Channel& channel = channels_[++last_channel_];
    channel.id = last_channel_;
    channel.topic = std::move(topic);
    came.push_back(&channel);
  }
  std::vector<std::uint32_t> left;
  for (const auto& [topic, id] : by_topic_) {
    if (!there.contains(id)) left.push_back(id);
  }
  for (const std::uint32_t id : left) {
    gone.push_back(id);
    forget(id);
  }
  for (const auto& [client, subscriber] : clients_) {
    if (!gone.empty()) {
      server_.send(client, json_text(Json{{"op", "unadvertise"}, {"channelIds", gone}}));
    }
    advertise(came, client);
  }
}

void FoxgloveBridge::forget(std::uint32_t id) {
  const auto channel = channels_.find(id);
  const std::string topic = channel->second.topic.name;
  if (channel->second.is_watched) topics_.unwatch(topic);
  for (auto& [client, subscriber] : clients_) {
    const auto found = subscriber.subscriptions.find(id);
    if (found == subscriber.subscriptions.end()) continue;
    subscriber.channels.erase(found->second);
    subscriber.subscriptions.erase(found);
  }
  by_topic_.erase(topic);
  channels_.erase(channel);
}

void FoxgloveBridge::advertise(const std::vector<const Channel*>& channels, Client client) {
  if (channels.empty()) return;
  Json list = Json::array();
  for (const Channel* channel : channels) {
    const TopicSource::Schema schema = topics_.schema_of(channel->topic);
    list.push_back({{"id", channel->id},
                    {"topic", channel->topic.name},
                    {"encoding", "cdr"},
                    {"schemaName", schema.name},
                    {"schema", schema.text},
                    {"schemaEncoding", "ros2msg"}});
  }
  server_.send(client, json_text(Json{{"op", "advertise"}, {"channels", list}}));
}

void FoxgloveBridge::watch(Channel& channel) {
  const std::uint32_t id = channel.id;
  channel.is_watched =
      topics_.watch(channel.topic.name, [this, id](const TopicSource::Message& message) {
        auto cdr =
            std::make_shared<const std::vector<std::byte>>(message.cdr.begin(), message.cdr.end());
        {
          const std::scoped_lock lock{mutex_};
          arrived_dropped_ += message.lost_before;
          if (arrived_bytes_ + cdr->size() > kMostArrived) {
            ++arrived_dropped_;
            return;
          }
          arrived_bytes_ += cdr->size();
          arrived_.emplace_back(id, Message{message.time, std::move(cdr)});
        }
        server_.wake();
      });
}

void FoxgloveBridge::forward() {
  std::deque<std::pair<std::uint32_t, Message>> messages;
  std::uint64_t lost = 0;
  {
    const std::scoped_lock lock{mutex_};
    messages = std::exchange(arrived_, {});
    arrived_bytes_ = 0;
    lost = std::exchange(arrived_dropped_, 0);
  }
  lost_ += lost;
  for (auto& [client, subscriber] : clients_) {
    if (!subscriber.channels.empty()) subscriber.lost += lost;
  }
  for (const auto& [id, message] : messages) {
    const auto place = channels_.find(id);
    if (place == channels_.end()) continue;  // it went while the message waited
    Channel& channel = place->second;
    for (const auto& [client, subscriber] : clients_) {
      const auto found = subscriber.subscriptions.find(id);
      if (found != subscriber.subscriptions.end()) send(client, found->second, message);
    }
    if (channel.topic.keeps == 0 || !channel.is_watched) continue;
    channel.kept.push_back(message);
    if (channel.kept.size() > channel.topic.keeps) channel.kept.pop_front();
    std::size_t bytes = 0;
    for (const Message& kept : channel.kept) bytes += kept.cdr->size();
    for (; bytes > kMostKept && channel.kept.size() > 1; channel.kept.pop_front()) {
      bytes -= channel.kept.front().cdr->size();
    }
  }
}

void FoxgloveBridge::send(Client client, std::uint32_t subscription, const Message& message) {
  server_.send(client, message_head(subscription, message.time), message.cdr);
}

void FoxgloveBridge::send_error(Client client, const std::string& why) {
  server_.send(client, status(kError, why));
}

Duration FoxgloveBridge::play() {
  Playback& playback = *options_.playback;
  forward();
  const Playback::State before = playback.state();
  const Playback::Advance advance = playback.advance();
  const Playback::State after = playback.state();
  // A client forgets what came before a jump, and expects nothing behind an end.
  if (advance.jumped) tell_jump();
  forward();
  // It also begins when somebody looks at a topic.
  if (!advance.jumped && after.status != told_status_) tell_playback(false);
  if (after != before) tell_time();
  return advance.next;
}

void FoxgloveBridge::tell_playback(bool jumped, Client asker, std::string_view request_id) {
  const Playback::State state = options_.playback->state();
  told_status_ = state.status;
  for (const auto& [client, subscriber] : clients_) {
    if (!subscriber.controls) continue;
    const std::string_view id = client == asker ? request_id : std::string_view{};
    server_.send_for_sure(client, playback_state_message(state, jumped, id));
  }
}

void FoxgloveBridge::tell_jump(Client asker, std::string_view request_id) {
  for (auto& [id, channel] : channels_) channel.kept.clear();
  tell_playback(true, asker, request_id);
}

void FoxgloveBridge::tell_time() {
  const std::vector<std::byte> time = time_message(options_.playback->state().at);
  for (const auto& [client, subscriber] : clients_) server_.send(client, time, nullptr);
}

void FoxgloveBridge::tell_refusal(const WebServer::Refusal& refusal) {
  if (refusals_.is_new(refusal.about)) options_.on_note(refusal.why);
}

void FoxgloveBridge::tell_loss(const std::string& what, std::uint64_t count) {
  const std::string number = std::to_string(count);
  const bool is_due = count > 0 && losses_.is_new(fmt::format("{} {}", what, number.size()));
  if (is_due) options_.on_note(fmt::format("{} messages were {}", number, what));
}

void FoxgloveBridge::tell_dropped() {
  tell_loss("lost on the way to the bridge", lost_);
  for (auto& [client, subscriber] : clients_) {
    const std::uint64_t dropped = server_.dropped(client);
    tell_loss(fmt::format("dropped: they came faster than client {} reads", client), dropped);
    // Who has not read what it was told last is told all of it later.
    if (server_.is_behind(client)) continue;
    const auto warn = [&, to = client](std::uint64_t count, std::string_view how) {
      if (count > 0)
        server_.send(to, status(kWarning, fmt::format("{} messages were {}", count, how)));
    };
    warn(dropped - std::exchange(subscriber.told_dropped, dropped),
         "dropped: they came faster than this client reads");
    warn(std::exchange(subscriber.lost, 0), "lost on the way to the bridge");
  }
}

}  // namespace armature
