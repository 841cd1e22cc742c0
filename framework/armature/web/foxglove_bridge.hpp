// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "armature/web/playback.hpp"
#include "armature/web/told_once.hpp"
#include "armature/web/topic_source.hpp"
#include "armature/web/web_server.hpp"

namespace armature ARMATURE_EXPORT {

/// Shows topics to programs that speak Foxglove's WebSocket protocol: raw CDR with ros2msg schemas.
/// A topic is read only while somebody is subscribed to it, once at most from each client; nothing
/// can be published through it. A
/// recording can be played, paused and sought in by clients that speak foxglove.sdk.v1.
/// Source: github.com/foxglove/ws-protocol, docs/spec.md (foxglove.websocket.v1; foxglove.sdk.v1
/// frames its messages in the same way and adds those of playback).
class FoxgloveBridge {
 public:
  struct Options {
    WebServer::Options server;
    /// By `run`. Why somebody was not let in, once for each reason, as some clients try for ever,
    /// and once for each address that asks for another protocol; a hundred times at most. How many
    /// messages did not come here or were dropped for a client: the first ones, and again when
    /// their number has a digit more; a hundred times at most.
    std::function<void(const std::string& note)> on_note = [](const std::string&) {};
    Playback* playback = nullptr;  // of the topics, which is then served; outlives the bridge
  };

  /// `topics` outlive the bridge. Throws std::runtime_error when the port cannot be had.
  FoxgloveBridge(TopicSource& topics, Options options);
  ~FoxgloveBridge();
  FoxgloveBridge(const FoxgloveBridge&) = delete;
  FoxgloveBridge& operator=(const FoxgloveBridge&) = delete;

  int port() const { return server_.port(); }
  /// Serves on this thread until `ends` is true, which is asked ten times a second.
  void run(const std::function<bool()>& ends);
  /// After `run`, or by its thread: messages that came faster than they were read, by all clients
  /// there have been.
  std::uint64_t dropped() const;

 private:
  using Client = WebServer::Client;
  using Body = WebServer::Body;
  struct Message {
    Time time;
    Body cdr;
  };
  struct Channel {
    std::uint32_t id = 0;
    TopicSource::Topic topic;
    std::deque<Message> kept;  // while it is watched, for those who come later
    bool is_watched = false;
  };
  struct Subscriber {
    bool controls = false;                            // its protocol has messages of playback
    std::map<std::uint32_t, std::uint32_t> channels;  // by the client's number of the subscription
    std::map<std::uint32_t, std::uint32_t> subscriptions;  // the other way round: one of a channel
    std::uint64_t told_dropped = 0;
    std::uint64_t lost = 0;  // of all that is read, since it was told of that
  };

  WebServer::Events events();
  void opened(Client client, std::string_view protocol);
  void closed(Client client);
  void said(Client client, std::string_view text);
  void said_binary(Client client, std::string_view message);
  void subscribe(Client client, std::uint32_t subscription, std::uint32_t channel);
  void unsubscribe(Client client, std::uint32_t subscription);
  /// Advertises what came up since the last look, and takes back what is gone.
  void look();
  /// Ends whatever is about a channel whose topic is gone.
  void forget(std::uint32_t channel);
  void advertise(const std::vector<const Channel*>& channels, Client client);
  void watch(Channel& channel);
  void leave_alone(std::uint32_t channel);
  void forward();
  void send(Client client, std::uint32_t subscription, const Message& message);
  void send_error(Client client, const std::string& why);
  /// Plays on; returns how long until there is more to do.
  Duration play();
  /// Tells everybody how the playback is; `asker` with the number of its request.
  void tell_playback(bool jumped, Client asker = 0, std::string_view request_id = {});
  /// The same of one that has jumped; what was kept is of another time.
  void tell_jump(Client asker = 0, std::string_view request_id = {});
  void tell_time();
  void tell_dropped();
  void tell_loss(const std::string& what, std::uint64_t count);
  void tell_refusal(const WebServer::Refusal& refusal);

  TopicSource& topics_;
  Options options_;
  std::map<std::uint32_t, Channel> channels_;  // that are there; no number comes twice
  std::map<std::string, std::uint32_t> by_topic_;
  std::map<Client, Subscriber> clients_;
  ToldOnce refusals_, losses_;
  std::uint32_t last_channel_ = 0;
  Playback::Status told_status_ = Playback::Status::paused;  // of the playback, to everybody
  std::uint64_t dropped_ = 0;                                // of those who have left
  std::uint64_t lost_ = 0;                                   // on the way to the bridge

  static constexpr std::size_t kMostArrived = 64U << 20;  // [byte]
  std::mutex mutex_;
  std::deque<std::pair<std::uint32_t, Message>> arrived_;  // by channel
  std::size_t arrived_bytes_ = 0;
  std::uint64_t arrived_dropped_ = 0;

  WebServer server_;
};

}  // namespace armature
