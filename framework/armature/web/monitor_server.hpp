// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "armature/web/web_server.hpp"

namespace armature ARMATURE_EXPORT {

/// Where the page of a monitor is, and who may connect.
struct MonitorAddress {
  std::string address = "127.0.0.1";  // IPv4 address of this machine
  int port = 8765;                    // that Foxglove asks for; 0: any that is free
  std::vector<std::string> origins;   // of pages, beside those of Foxglove and Lichtblick
  std::string token;                  // that clients must say; empty: none
};

/// Whether only programs of this machine reach an address.
bool is_loopback(const std::string& address);
/// 128 bits that nobody guesses, as 32 digits. Throws std::runtime_error when the system has none.
std::string new_token();
/// A server with the page that came with Armature, for both protocols of Foxglove.
WebServer::Options monitor_server(const MonitorAddress& address);
/// The addresses to open, a line each: of the page and of the socket. `port` is the one that is
/// served.
std::string monitor_links(const MonitorAddress& address, int port);

}  // namespace armature
