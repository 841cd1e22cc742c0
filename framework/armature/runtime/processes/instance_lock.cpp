// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/processes/instance_lock.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <optional>
#include <string_view>
#include <thread>

#include "armature/runtime/deployment_file/sha256.hpp"

namespace armature {
namespace {

/// An address in the abstract namespace: it begins with a zero byte, and no file stands for it.
struct Address {
  explicit Address(const std::string& name) {
    std::string path = "armature/" + name;
    if (path.size() >= sizeof address.sun_path) path = "armature/" + sha256(name);
    path.copy(address.sun_path + 1, path.size());
    size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + path.size());
  }
  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&address); }

  sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
  socklen_t size;
};

int open_socket() { return socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0); }

/// Who listens there, as the kernel saw it; nothing: nobody does.
std::optional<std::string> holder_of(const Address& address) {
  const int own = open_socket();
  ucred holder{};
  socklen_t size = sizeof holder;
  std::optional<std::string> told;
  if (connect(own, address.get(), address.size) == 0) {
    const bool known =
        getsockopt(own, SOL_SOCKET, SO_PEERCRED, &holder, &size) == 0 && holder.pid > 0;
    told = known ? fmt::format("pid {}", holder.pid) : "a process of another container";
  } else if (errno == EAGAIN) {
    told = "a process that thousands have asked for already";
  }
  close(own);
  return told;
}

}  // namespace

Expected<InstanceLock> InstanceLock::take(const std::string& name) {
  // A holder that just ended, or has not yet begun to listen, is neither there nor gone.
  constexpr int kAttempts = 100;
  constexpr std::chrono::milliseconds kPause{2};
  const Address address{name};
  const int own = open_socket();
  if (own < 0) return refuse(fmt::format("nobody knows: no Unix socket: {}", std::strerror(errno)));
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (bind(own, address.get(), address.size) == 0 && listen(own, SOMAXCONN) == 0) {
      return InstanceLock{own};
    }
    if (const auto holder = holder_of(address)) {
      close(own);
      return refuse(*holder);
    }
    std::this_thread::sleep_for(kPause);
  }
  close(own);
  return refuse("a process that does not say who it is");
}

Expected<void> InstanceLock::check(const std::string& name) {
  if (const auto holder = holder_of(Address{name})) return refuse(*holder);
  return {};
}

InstanceLock::~InstanceLock() {
  if (socket_ >= 0) close(socket_);
}

}  // namespace armature
