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

ControlChannel::ControlChannel(int file) : file_{file} {
  if (file_ >= 0) fcntl(file_, F_SETFD, FD_CLOEXEC);
}

ControlChannel::~ControlChannel() {
  if (file_ >= 0) close(file_);
}

std::pair<ControlChannel, ControlChannel> ControlChannel::make() {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw std::system_error(errno, std::generic_category(), "cannot make a control channel");
  }
  return {ControlChannel{ends[0]}, ControlChannel{ends[1]}};
}

void ControlChannel::send(std::string_view line) {
  line = line.substr(0, kMaxControlLine);
  if (file_ >= 0) ::send(file_, line.data(), line.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

std::optional<std::string> ControlChannel::receive() {
  if (file_ < 0 || lost_) return std::nullopt;
  std::array<char, kMaxControlLine> line{};
  const ssize_t size = recv(file_, line.data(), line.size(), MSG_DONTWAIT);
  if (size > 0) return std::string{line.data(), static_cast<std::size_t>(size)};
  lost_ = size == 0 || (errno != EAGAIN && errno != EINTR);
  return std::nullopt;
}

}  // namespace armature
