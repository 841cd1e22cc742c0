// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// A WebSocket server on one thread. A client that reads slowly has a bounded queue, and loses its
/// oldest binary messages when that is full; where those that must not be lost fill it, the client
/// is closed, and told why. It slows nobody. Clients are refused that ask for no
/// protocol the server speaks, that come from a page of a foreign origin, or have no right token,
/// and those that come when 32 are connected; the answer of HTTP tells them why.
class WebServer {
 public:
  /// The page that HTTP serves, at `/` only and to everybody.
  struct Page {
    std::string text;
    std::string type = "text/plain; charset=utf-8";
    std::string security_policy = "default-src 'none'";  // Content-Security-Policy
  };
  static constexpr std::size_t kMaxTokenBytes = 1000;
  struct Options {
    std::string address = "127.0.0.1";  // IPv4, that it is bound to
    int port = 0;                       // 0: any that is free
    std::vector<std::string> protocols;
    /// Pages that may connect, beside those of this address and port: "https://app.foxglove.dev".
    std::vector<std::string> origins;
    std::string origin_option = "--origin";  // what lets another one in, for people
    std::string token;                       // empty: none is asked for; at most kMaxTokenBytes
    std::size_t queue_bytes = 16U << 20;     // of all that waits for a client to read it
    Page page;                               // for whoever comes with a browser
  };
  using Client = std::uint64_t;  // never used twice
  /// Somebody was not let in, or shown out.
  struct Refusal {
    std::string about;  // the same for what one need not be told twice
    std::string why;    // and what would let him in
  };
  /// All are called by `serve`.
  struct Events {
    /// `protocol`: which of the server's it speaks.
    std::function<void(Client, std::string_view protocol)> opened;
    std::function<void(Client)> closed;
    std::function<void(Client, std::string_view text)> said;
    std::function<void(Client, std::string_view bytes)> said_binary = [](Client, std::string_view) {
    };
    std::function<void()> woken;
    std::function<void(const Refusal&)> refused = [](const Refusal&) {};
  };
  using Body = std::shared_ptr<const std::vector<std::byte>>;

  /// Throws std::runtime_error when the port cannot be had.
  WebServer(Options options, Events events);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  int port() const;
  /// Handles what there is to do, and waits for more until `wake`, but no longer than `at_most`.
  void serve(Duration at_most = std::chrono::milliseconds{100});
  /// From any thread.
  void wake();

  // By the thread that serves:
  void send(Client client, std::string text);
  /// A binary message: `head` of at most 16 bytes, then `body`, which several clients may share.
  void send(Client client, std::span<const std::byte> head, Body body);
  /// A binary message that is not dropped, as a text is not.
  void send_for_sure(Client client, std::span<const std::byte> message);
  /// The number of binary messages that this client has lost.
  std::uint64_t dropped(Client client) const;
  /// Whether anything that is not dropped still waits for this client to read it.
  bool is_behind(Client client) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace armature
