// SPDX-License-Identifier: Apache-2.0
#include "bench/loop/page.hpp"

#include <nlohmann/json.hpp>

#include "armature/values/json_text.hpp"
#include "armature/web/web_socket.hpp"
#include "exit_code.hpp"

namespace armature::bench {

int read_as_a_page(int port) {
  WebSocket monitor{port, "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n"};
  if (!monitor.is_open()) return kFailed;
  constexpr int kText = 1;
  while (const auto frame = monitor.next()) {
    if (frame->op != kText) continue;
    const auto told = nlohmann::json::parse(frame->payload, nullptr, false);
    if (told.is_discarded() || told.value("op", "") != "advertise") continue;
    nlohmann::json wanted = nlohmann::json::array();
    for (const auto& channel : told["channels"]) {
      wanted.push_back({{"id", channel["id"]}, {"channelId", channel["id"]}});
    }
    monitor.send_text(
        json_text(nlohmann::json{{"op", "subscribe"}, {"subscriptions", std::move(wanted)}}));
  }
  return kOk;
}

}  // namespace armature::bench
