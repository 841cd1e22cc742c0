// SPDX-License-Identifier: Apache-2.0
#include "monitor/monitor.hpp"

#include <fmt/format.h>
#include <sys/random.h>

#include <array>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "exit_code.hpp"
#include "monitor/foxglove_bridge.hpp"
#include "verbs/shipped_configs.hpp"

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

/// The page that came with armature, in one file; plain text where it is missing.
WebServer::Page shipped_page() {
  std::ifstream file{shipped_folder("monitor") / "index.html", std::ios::binary};
  if (!file) {
    return {.text =
                "Armature shows a running deployment here to Foxglove and Lichtblick:\n"
                "open a connection, Foxglove WebSocket, with the address of this page, ws:// in "
                "front.\n"};
  }
  // It loads nothing, runs its own script, and speaks to WebSockets; which script and style are its
  // own it says itself, by their hashes.
  return {.text = {std::istreambuf_iterator<char>{file}, {}},
          .type = "text/html; charset=utf-8",
          .security_policy =
              "default-src 'none'; script-src 'unsafe-inline'; style-src "
              "'unsafe-inline'; img-src data: blob:; connect-src 'self' ws: wss:; "
              "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"};
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
      .page = shipped_page()};
  server.origins.insert(server.origins.end(), options.origins.begin(), options.origins.end());
  const std::string query = server.token.empty() ? "" : "/?token=" + server.token;
  FoxgloveBridge bridge{options, std::move(server)};
  const std::string place = fmt::format("{}:{}{}", options.address, bridge.port(), query);
  tell(fmt::format("http://{0}{1}\nws://{0}", place, query.empty() ? "/" : ""));
  bridge.run();
  if (bridge.dropped() > 0) {
    fmt::print(stderr,
               "armature: {} messages came faster than they were read, or were lost on the way\n",
               bridge.dropped());
  }
  return kOk;
}

}  // namespace armature
