// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace armature {

/// A connection to a port of this machine; not open when nobody listens there.
inline int connect_here(int port) {
  const int file = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  static_cast<void>(connect(file, reinterpret_cast<sockaddr*>(&address), sizeof address));
  return file;
}

/// A client of a WebSocket server on this machine, that can also be one that misbehaves.
class WebSocket {
 public:
  struct Frame {
    int op = 0;  // 1 text, 2 binary, 8 close
    std::string payload;
  };

  /// `headers`: lines of the request beside the usual ones, "Origin: http://..".
  /// `host`: by which name the machine was asked, 127.0.0.1 with the port unless said otherwise.
  WebSocket(int port, const std::string& headers, const std::string& path = "/",
            const std::string& host = "")
      : file_{connect_here(port)} {
    say("GET " + path +
        " HTTP/1.1\r\nHost: " + (host.empty() ? "127.0.0.1:" + std::to_string(port) : host) +
        "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
        headers + "\r\n");
    while (heard_.find("\r\n\r\n") == std::string::npos && hear()) continue;
    is_open_ = heard_.starts_with("HTTP/1.1 101 ");
    while (!is_open_ && hear()) continue;
    if (!is_open_) answer_ = heard_;
    heard_.erase(0, heard_.find("\r\n\r\n") + 4);
  }
  ~WebSocket() { close(file_); }
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  bool is_open() const { return is_open_; }
  /// What HTTP answered where it did not open.
  const std::string& answer() const { return answer_; }

  void send_text(const std::string& text) { send_frame('\x81', text); }
  void send_binary(const std::string& bytes) { send_frame('\x82', bytes); }
  /// A part of a text, the first one or a later one, without an end.
  void send_part(const std::string& text, bool first) { send_frame(first ? '\x01' : '\0', text); }
  /// The next frame; nothing: the connection is closed, or it is silent for 20 s.
  std::optional<Frame> next() {
    if (!has(2)) return std::nullopt;
    std::size_t head = 2, size = byte(1) & 0x7F;
    if (size >= 126) {
      const std::size_t more = size == 126 ? 2 : 8;
      if (!has(2 + more)) return std::nullopt;
      size = 0;
      for (std::size_t i = 0; i < more; ++i) size = size << 8 | byte(2 + i);
      head += more;
    }
    if (!has(head + size)) return std::nullopt;
    Frame frame{.op = static_cast<int>(byte(0) & 0x0F), .payload = heard_.substr(head, size)};
    heard_.erase(0, head + size);
    return frame;
  }

 private:
  /// Masked with zeros.
  void send_frame(char head, const std::string& text) {
    std::string frame(1, head);
    if (text.size() < 126) {
      frame += static_cast<char>(0x80 | text.size());
    } else {
      const bool is_long = text.size() > 0xFFFF;
      frame += static_cast<char>(0x80 | (is_long ? 127 : 126));
      for (int bits = is_long ? 56 : 8; bits >= 0; bits -= 8) {
        frame += static_cast<char>(text.size() >> bits);
      }
    }
    say(frame + std::string(4, '\0') + text);
  }
  std::size_t byte(std::size_t i) const { return static_cast<unsigned char>(heard_[i]); }
  bool has(std::size_t size) {
    while (heard_.size() < size) {
      if (!hear()) return false;
    }
    return true;
  }
  bool hear() {
    constexpr int kSilence_ms = 20'000;
    pollfd input{.fd = file_, .events = POLLIN, .revents = 0};
    if (poll(&input, 1, kSilence_ms) <= 0) return false;
    std::vector<char> bytes(65'536);
    const ssize_t count = read(file_, bytes.data(), bytes.size());
    if (count > 0) heard_.append(bytes.data(), static_cast<std::size_t>(count));
    return count > 0;
  }
  void say(const std::string& bytes) {
    const ssize_t said = send(file_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    is_open_ = said == static_cast<ssize_t>(bytes.size());
  }

  int file_;
  bool is_open_ = false;
  std::string heard_;
  std::string answer_;
};

}  // namespace armature
