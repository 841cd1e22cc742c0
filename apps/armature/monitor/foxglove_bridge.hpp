// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "monitor/web_server.hpp"
#include "watch/outsider.hpp"

namespace armature {

/// Shows the topics of a DDS domain to programs that speak Foxglove's WebSocket protocol: raw CDR
/// with ros2msg schemas. A topic is read only while somebody is subscribed to it; nothing can be
/// published through it.
/// Source: github.com/foxglove/ws-protocol, docs/spec.md (foxglove.websocket.v1; foxglove.sdk.v1
/// frames its messages in the same way).
class FoxgloveBridge {
 public:
  FoxgloveBridge(const WatchOptions& options, WebServer::Options server);

  int port() const { return server_.port(); }
  /// Until it is time to leave.
  void run();
  /// Messages that came faster than they were read, by all clients there have been.
  std::uint64_t dropped() const;

 private:
  using Client = WebServer::Client;
  using Body = WebServer::Body;
  struct Sample {
    Time sent;
    Body cdr;
  };
  struct Channel {
    std::uint32_t id = 0;
    std::string topic, type;
    bool latched = false;     // DDS keeps what was written for those who come later,
    std::deque<Sample> kept;  // and so does the bridge while it reads the topic
    bool is_watched = false;
    bool is_there = true;
  };
  struct Subscriber {
    std::map<std::uint32_t, std::uint32_t> channels;  // by the client's number of the subscription
    std::uint64_t told_dropped = 0;
  };

  void opened(Client client);
  void closed(Client client);
  void said(Client client, std::string_view text);
  void subscribe(Client client, std::uint32_t subscription, std::uint32_t channel);
  void unsubscribe(Client client, std::uint32_t subscription);
  /// Advertises what came up since the last look, and takes back what is gone.
  void look();
  void advertise(const std::vector<const Channel*>& channels, Client client);
  void watch(Channel& channel);
  void leave_alone(std::uint32_t channel);
  void forward();
  void send(Client client, std::uint32_t subscription, const Sample& sample);
  void tell_dropped();
  /// Once for each reason: some clients try for ever.
  void tell_refusal(const std::string& why);

  std::map<std::uint32_t, Channel> channels_;
  std::map<std::string, std::uint32_t> by_topic_;
  std::map<Client, Subscriber> clients_;
  std::set<std::string> refusals_;
  std::uint32_t last_channel_ = 0;
  std::uint64_t dropped_ = 0;  // of those who have left

  static constexpr std::size_t kMostArrived = 64U << 20;  // [byte]
  std::mutex mutex_;
  std::deque<std::pair<std::uint32_t, Sample>> arrived_;  // by channel
  std::size_t arrived_bytes_ = 0;
  std::uint64_t arrived_dropped_ = 0;

  WebServer server_;
  Outsider outsider_;  // goes before what its callbacks use
};

}  // namespace armature
