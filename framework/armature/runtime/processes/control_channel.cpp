// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/processes/control_channel.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

namespace armature {
namespace {

constexpr std::size_t kMaxControlLine = 4000;

}  // namespace

SocketChannel::SocketChannel(int file) : file_{file} {
  if (file_ >= 0) fcntl(file_, F_SETFD, FD_CLOEXEC);
}

SocketChannel::~SocketChannel() {
  if (file_ >= 0) close(file_);
}

std::pair<SocketChannel, SocketChannel> SocketChannel::make() {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw std::system_error(errno, std::generic_category(), "cannot make a control channel");
  }
  return {SocketChannel{ends[0]}, SocketChannel{ends[1]}};
}

void SocketChannel::send(std::string_view line) {
  line = line.substr(0, kMaxControlLine);
  if (file_ >= 0) ::send(file_, line.data(), line.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

std::optional<std::string> SocketChannel::receive() {
  if (file_ < 0 || lost_) return std::nullopt;
  std::array<char, kMaxControlLine> line{};
  ssize_t size = 0;
  // An end that is gone and has left lines of ours unread tells that before its own last lines.
  do {
    size = recv(file_, line.data(), line.size(), MSG_DONTWAIT);
  } while (size < 0 && (errno == ECONNRESET || errno == EINTR));
  if (size > 0) return std::string{line.data(), static_cast<std::size_t>(size)};
  lost_ = size == 0 || errno != EAGAIN;
  return std::nullopt;
}

}  // namespace armature
