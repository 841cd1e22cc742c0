// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "armature/messages/cdr_to_json.hpp"
#include "armature/messages/known_types.hpp"
#include "armature/web/web_socket.hpp"

namespace armature::test {

// What a client of Foxglove's WebSocket protocol does, on a WebSocket.

inline std::string protocol(const std::string& name) {
  return "Sec-WebSocket-Protocol: " + name + "\r\n";
}

/// The channel of a topic, once it is advertised.
inline nlohmann::json channel_of(const std::string& topic, WebSocket& socket) {
  while (const auto frame = socket.next()) {
    if (frame->op != 1) continue;
    const nlohmann::json told = nlohmann::json::parse(frame->payload);
    if (told["op"] != "advertise") continue;
    for (const nlohmann::json& channel : told["channels"]) {
      if (channel["topic"] == topic) return channel;
    }
  }
  ADD_FAILURE() << topic << " was not advertised";
  return {};
}

inline void subscribe(int subscription, const nlohmann::json& channel, WebSocket& socket) {
  socket.send_text(
      nlohmann::json{{"op", "subscribe"},
                     {"subscriptions", {{{"id", subscription}, {"channelId", channel["id"]}}}}}
          .dump());
}

/// The message of a frame, read by its type; nothing when it is of another subscription.
inline std::optional<nlohmann::json> read_message(const WebSocket::Frame& frame,
                                                  std::uint32_t subscription, const char* type) {
  constexpr std::size_t kHead = 13;
  if (frame.op != 2 || frame.payload.size() < kHead || frame.payload[0] != 1) return std::nullopt;
  std::uint32_t told = 0;
  std::memcpy(&told, frame.payload.data() + 1, sizeof told);
  if (told != subscription) return std::nullopt;
  const std::string cdr = frame.payload.substr(kHead);
  const auto read = cdr_to_json(*describe_type(type), std::as_bytes(std::span{cdr}));
  EXPECT_TRUE(read) << read.error().text;
  return read ? nlohmann::json::parse(read->dump()) : nlohmann::json{};
}

/// The next message of a subscription, read by its type.
inline nlohmann::json message_of(std::uint32_t subscription, const char* type, WebSocket& socket) {
  while (const auto frame = socket.next()) {
    if (auto message = read_message(*frame, subscription, type)) return *message;
  }
  ADD_FAILURE() << "no message of " << type;
  return {};
}

}  // namespace armature::test
