// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "armature/web/web_server.hpp"

namespace armature {

/// Who asks a WebSocket server for a connection, as its request tells.
struct Visitor {
  std::string address;    // of its machine
  std::string protocols;  // Sec-WebSocket-Protocol: "lamp.v1, lamp.v2"
  std::string token;
  std::string origin;  // of the page that asks; empty: no browser
  std::string host;    // by which name it was asked
};

struct NotAdmitted {
  WebServer::Refusal told;
  unsigned status = 0;  // of HTTP
  std::string answer;   // for the visitor, without anything that it has said itself
};

/// Nothing: it is welcome. `port`: where the server listens; `clients`: how many are connected.
std::optional<NotAdmitted> admission(const Visitor& visitor, const WebServer::Options& options,
                                     int port, std::size_t clients);

}  // namespace armature
