// SPDX-License-Identifier: Apache-2.0
#include "armature/web/monitor_server.hpp"

#include <fmt/format.h>
#include <sys/random.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>

#include "armature/bus/network_interface.hpp"

namespace armature {
namespace {

/// The page that came with Armature, in one file; plain text where it is missing.
WebServer::Page shipped_page() {
  const auto prefix = std::filesystem::canonical("/proc/self/exe").parent_path().parent_path();
  std::ifstream file{prefix / "share/armature/monitor/index.html", std::ios::binary};
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

/// Text as it stands in a query of an address (RFC 3986, section 2): what is reserved, as %XX.
std::string percent_encoded(std::string_view text) {
  constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
  std::string encoded;
  for (const char c : text) {
    if (kPlain.find(c) != std::string_view::npos) {
      encoded += c;
    } else {
      encoded += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
  }
  return encoded;
}

}  // namespace

bool is_loopback(const std::string& address) { return address.starts_with("127."); }

std::string new_token() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw std::runtime_error("the system has no random numbers for a token; give one: --token");
  }
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

WebServer::Options monitor_server(const MonitorAddress& address) {
  WebServer::Options server{
      .address = address.address,
      .port = address.port,
      .protocols = {"foxglove.sdk.v1", "foxglove.websocket.v1"},
      .origins = {"https://app.foxglove.dev", "https://lichtblick-suite.github.io"},
      .token = address.token,
      .page = shipped_page()};
  server.origins.insert(server.origins.end(), address.origins.begin(), address.origins.end());
  return server;
}

/// Links to the address, for 0.0.0.0 to that of every interface; one that only this machine reaches
/// comes last.
std::string monitor_links(const MonitorAddress& address, int port) {
  if (address.address == "0.0.0.0") {
    std::string links;
    MonitorAddress one = address;
    for (const NetworkInterface& interface : network_interfaces()) {
      if (!interface.up || !interface.has_link) continue;
      for (const std::string& own : interface.addresses) {
        one.address = own;
        links = monitor_links(one, port) + (links.empty() ? "" : '\n' + links);
      }
    }
    if (!links.empty()) return links;
  }
  const std::string query =
      address.token.empty() ? "" : "/?token=" + percent_encoded(address.token);
  const std::string place = fmt::format("{}:{}{}", address.address, port, query);
  return fmt::format("http://{0}{1}\nws://{0}", place, query.empty() ? "/" : "");
}

}  // namespace armature
