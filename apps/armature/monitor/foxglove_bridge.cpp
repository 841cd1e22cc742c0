// SPDX-License-Identifier: Apache-2.0
#include "monitor/foxglove_bridge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "armature/bus/topic_name.hpp"
#include "armature/messages/known_types.hpp"
#include "armature/messages/ros_definition.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostKept = 100;  // samples of a latched topic
constexpr std::size_t kHeadBytes = 13;
enum Level { kWarning = 1, kError = 2 };

std::string status(Level level, const std::string& text) {
  return Json{{"op", "status"}, {"level", level}, {"message", text}}.dump();
}

}  // namespace

FoxgloveBridge::FoxgloveBridge(const WatchOptions& options, WebServer::Options server)
    : server_{std::move(server),
              {.opened = [this](Client client) { opened(client); },
               .closed = [this](Client client) { closed(client); },
               .said = [this](Client client, std::string_view text) { said(client, text); },
               .woken = [this] { forward(); },
               .refused = [this](const std::string& why) { tell_refusal(why); }}},
      outsider_{options} {}

void FoxgloveBridge::run() {
  Time next;
  while (!left()) {
    if (const Time now = monotonic_now(); now >= next) {
      look();
      tell_dropped();
      next = now + seconds(0.2);
    }
    server_.serve();
  }
}

std::uint64_t FoxgloveBridge::dropped() const {
  std::uint64_t dropped = dropped_;
  for (const auto& [client, subscriber] : clients_) dropped += server_.dropped(client);
  return dropped;
}

void FoxgloveBridge::opened(Client client) {
  clients_[client];
  server_.send(client, Json{{"op", "serverInfo"},
                            {"name", "armature"},
                            {"capabilities", Json::array()},
                            {"metadata", Json::object()},
                            {"sessionId", fmt::format("{}", monotonic_now().ns)}}
                           .dump());
  std::vector<const Channel*> all;
  for (const auto& [id, channel] : channels_) {
    if (channel.is_there) all.push_back(&channel);
  }
  advertise(all, client);
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
  const auto json = nlohmann::json::parse(text, nullptr, false);
  const auto refuse_with = [&](const std::string& why) {
    server_.send(client, status(kError, why));
  };
  if (!json.is_object()) return refuse_with("what was said is no JSON object");
  try {
    const std::string op = json.at("op");
    if (op == "subscribe") {
      for (const auto& one : json.at("subscriptions")) {
        subscribe(client, one.at("id"), one.at("channelId"));
      }
    } else if (op == "unsubscribe") {
      for (const auto& subscription : json.at("subscriptionIds")) unsubscribe(client, subscription);
    } else {
      refuse_with(fmt::format("'{}' is not done here: a monitor only shows", op));
    }
  } catch (const nlohmann::json::exception& error) {
    refuse_with(error.what());
  }
}

void FoxgloveBridge::subscribe(Client client, std::uint32_t subscription,
                               std::uint32_t channel_id) {
  auto& subscriptions = clients_.at(client).channels;
  const auto channel = channels_.find(channel_id);
  if (channel == channels_.end() || !channel->second.is_there) {
    return server_.send(client, status(kError, fmt::format("there is no channel {}", channel_id)));
  }
  if (!subscriptions.emplace(subscription, channel_id).second) {
    return server_.send(
        client, status(kError, fmt::format("subscription {} is used already", subscription)));
  }
  if (!channel->second.is_watched) return watch(channel->second);
  for (const Sample& sample : channel->second.kept) send(client, subscription, sample);
}

void FoxgloveBridge::unsubscribe(Client client, std::uint32_t subscription) {
  auto& subscriptions = clients_.at(client).channels;
  const auto found = subscriptions.find(subscription);
  if (found == subscriptions.end()) return;
  const std::uint32_t channel = found->second;
  subscriptions.erase(found);
  leave_alone(channel);
}

void FoxgloveBridge::leave_alone(std::uint32_t channel_id) {
  for (const auto& [client, subscriber] : clients_) {
    for (const auto& [subscription, channel] : subscriber.channels) {
      if (channel == channel_id) return;
    }
  }
  Channel& channel = channels_.at(channel_id);
  if (!std::exchange(channel.is_watched, false)) return;
  outsider_.dds().unwatch(channel.topic);
  channel.kept.clear();
}

void FoxgloveBridge::look() {
  std::set<std::uint32_t> there;
  std::vector<const Channel*> came;
  for (const ObservedTopic& topic : outsider_.dds().topics()) {
    const TypeDescription* type =
        topic.types.size() == 1 ? describe_type(topic.types.front()) : nullptr;
    if (topic.writers == 0 || !type) continue;
    const auto [place, is_new] = by_topic_.try_emplace(topic.name, last_channel_ + 1);
    if (is_new) channels_[place->second].id = ++last_channel_;
    Channel& channel = channels_[place->second];
    there.insert(channel.id);
    channel.latched = topic.endpoints.front().transient_local;
    if (!is_new && channel.is_there) continue;
    channel.topic = topic.name;
    channel.type = topic.types.front();
    channel.is_there = true;
    came.push_back(&channel);
  }
  Json gone = Json::array();
  for (auto& [id, channel] : channels_) {
    if (!channel.is_there || there.contains(id)) continue;
    channel.is_there = false;
    channel.kept.clear();
    if (std::exchange(channel.is_watched, false)) outsider_.dds().unwatch(channel.topic);
    for (auto& [client, subscriber] : clients_) {
      std::erase_if(subscriber.channels, [&](const auto& entry) { return entry.second == id; });
    }
    gone.push_back(id);
  }
  for (const auto& [client, subscriber] : clients_) {
    if (!gone.empty()) {
      server_.send(client, Json{{"op", "unadvertise"}, {"channelIds", gone}}.dump());
    }
    advertise(came, client);
  }
}

void FoxgloveBridge::advertise(const std::vector<const Channel*>& channels, Client client) {
  if (channels.empty()) return;
  Json list = Json::array();
  for (const Channel* channel : channels) {
    const TypeDescription& type = *describe_type(channel->type);
    list.push_back({{"id", channel->id},
                    {"topic", ros_topic_name(channel->topic)},
                    {"encoding", "cdr"},
                    {"schemaName", ros2_name(type)},
                    {"schema", ros_definition(type)},
                    {"schemaEncoding", "ros2msg"}});
  }
  server_.send(client, Json{{"op", "advertise"}, {"channels", list}}.dump());
}

void FoxgloveBridge::watch(Channel& channel) {
  const std::uint32_t id = channel.id;
  const auto watching =
      outsider_.dds().watch(channel.topic, Duration{0}, [this, id](const ObservedSample& sample) {
        auto cdr =
            std::make_shared<const std::vector<std::byte>>(sample.cdr.begin(), sample.cdr.end());
        {
          const std::scoped_lock lock{mutex_};
          arrived_dropped_ += sample.lost_before;
          if (arrived_bytes_ + cdr->size() > kMostArrived) {
            ++arrived_dropped_;
            return;
          }
          arrived_bytes_ += cdr->size();
          arrived_.emplace_back(id, Sample{sample.source, std::move(cdr)});
        }
        server_.wake();
      });
  channel.is_watched = watching.has_value();
}

void FoxgloveBridge::forward() {
  std::deque<std::pair<std::uint32_t, Sample>> samples;
  {
    const std::scoped_lock lock{mutex_};
    samples = std::exchange(arrived_, {});
    arrived_bytes_ = 0;
    dropped_ += std::exchange(arrived_dropped_, 0);
  }
  for (const auto& [id, sample] : samples) {
    Channel& channel = channels_.at(id);
    for (const auto& [client, subscriber] : clients_) {
      for (const auto& [subscription, subscribed] : subscriber.channels) {
        if (subscribed == id) send(client, subscription, sample);
      }
    }
    if (!channel.latched || !channel.is_watched) continue;
    if (channel.kept.size() == kMostKept) channel.kept.pop_front();
    channel.kept.push_back(sample);
  }
}

void FoxgloveBridge::send(Client client, std::uint32_t subscription, const Sample& sample) {
  constexpr std::byte kMessageData{1};
  std::array<std::byte, kHeadBytes> head{kMessageData};
  std::memcpy(head.data() + 1, &subscription, sizeof subscription);
  std::memcpy(head.data() + 1 + sizeof subscription, &sample.sent.ns, sizeof sample.sent.ns);
  server_.send(client, head, sample.cdr);
}

void FoxgloveBridge::tell_refusal(const std::string& why) {
  constexpr std::size_t kMostReasons = 100;
  const bool is_new = refusals_.size() < kMostReasons && refusals_.insert(why).second;
  if (is_new) fmt::print(stderr, "armature: {}\n", why);
}

void FoxgloveBridge::tell_dropped() {
  for (auto& [client, subscriber] : clients_) {
    const std::uint64_t dropped = server_.dropped(client);
    if (dropped == subscriber.told_dropped) continue;
    server_.send(client,
                 status(kWarning, fmt::format("{} messages were dropped: they came faster than "
                                              "this client reads",
                                              dropped - subscriber.told_dropped)));
    subscriber.told_dropped = dropped;
  }
}

}  // namespace armature
