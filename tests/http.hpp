// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>

#include "armature/web/web_socket.hpp"

namespace armature::test {

/// A browser that asks a server on this machine for a page, and reads as much of it as it is told.
class HttpClient {
 public:
  HttpClient(int port, const std::string& request) : file_{connect_here(port)} {
    const std::string text = request + " HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n";
    send(file_, text.data(), text.size(), MSG_NOSIGNAL);
  }
  ~HttpClient() { close(file_); }
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;

  /// All that is told until the connection is closed, or it is silent for 20 s.
  std::string read_all() {
    constexpr int kSilence_ms = 20'000;
    std::string text, part(65'536, '\0');
    pollfd input{.fd = file_, .events = POLLIN, .revents = 0};
    while (poll(&input, 1, kSilence_ms) > 0) {
      const ssize_t count = read(file_, part.data(), part.size());
      if (count <= 0) break;
      text.append(part.data(), static_cast<std::size_t>(count));
    }
    return text;
  }

 private:
  int file_;
};

}  // namespace armature::test
