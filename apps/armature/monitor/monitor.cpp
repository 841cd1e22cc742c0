// SPDX-License-Identifier: Apache-2.0
#include "monitor/monitor.hpp"

#include <fmt/format.h>
#include <sys/random.h>

#include <array>
#include <stdexcept>

#include "exit_code.hpp"
#include "monitor/foxglove_bridge.hpp"

namespace armature {
namespace {

/// 128 bits that nobody guesses.
std::string new_token() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw std::runtime_error("the system has no random numbers for a token; give one: --token");
  }
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

}  // namespace

int show_to_browsers(const MonitorOptions& options) {
  leave_in_order();
  const bool is_local = options.address.starts_with("127.");
  WebServer::Options server{
      .address = options.address,
      .port = options.port,
      .protocols = {"foxglove.sdk.v1", "foxglove.websocket.v1"},
      .origins = {"https://app.foxglove.dev", "https://lichtblick-suite.github.io"},
      .token = options.token.empty() && !is_local ? new_token() : options.token,
      .page =
          "Armature shows a running deployment here to Foxglove and Lichtblick:\n"
          "open a connection, Foxglove WebSocket, with the address of this page, ws:// in "
          "front.\n"};
  server.origins.insert(server.origins.end(), options.origins.begin(), options.origins.end());
  const std::string query = server.token.empty() ? "" : "/?token=" + server.token;
  FoxgloveBridge bridge{options, std::move(server)};
  tell(fmt::format("ws://{}:{}{}", options.address, bridge.port(), query));
  bridge.run();
  if (bridge.dropped() > 0) {
    fmt::print(stderr,
               "armature: {} messages came faster than they were read, or were lost on the way\n",
               bridge.dropped());
  }
  return kOk;
}

}  // namespace armature
