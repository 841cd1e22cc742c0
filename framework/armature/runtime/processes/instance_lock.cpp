// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/processes/instance_lock.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <optional>
#include <set>
#include <thread>

#include "armature/runtime/deployment_file/sha256.hpp"

namespace armature {
namespace {

const std::string kOurs = "armature/";

/// An address in the abstract namespace: it begins with a zero byte, and no file stands for it.
struct Address {
  explicit Address(const std::string& name) {
    std::string path = kOurs + name;
    if (path.size() >= sizeof address.sun_path) path = kOurs + sha256(name);
    path.copy(address.sun_path + 1, path.size());
    size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + path.size());
  }
  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&address); }

  sockaddr_un address{.sun_family = AF_UNIX};
  socklen_t size;
};

int open_socket() { return socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0); }

struct Holder {
  pid_t pid;  // 0: not known
  std::string text;
  bool is_here = true;  // else of another container
};

/// Who listens there, as the kernel saw it; nothing: nobody does.
std::optional<Holder> holder_of(const Address& address) {
  const int own = open_socket();
  ucred holder{};
  socklen_t size = sizeof holder;
  std::optional<Holder> told;
  if (connect(own, address.get(), address.size) == 0) {
    const bool known =
        getsockopt(own, SOL_SOCKET, SO_PEERCRED, &holder, &size) == 0 && holder.pid > 0;
    told = known ? Holder{holder.pid, fmt::format("pid {}", holder.pid)}
                 : Holder{0, "a process of another container", false};
  } else if (errno == EAGAIN) {
    told = Holder{0, "a process that thousands have asked for already"};
  }
  close(own);
  return told;
}

/// Locks of this process. What it forks, as a library may, and lets live on, holds none of them.
constexpr std::size_t kMaxLocks = 64;
std::array<std::atomic<int>, kMaxLocks> g_locks;  // descriptor + 1; 0: free

void let_go_in_child() {
  for (auto& lock : g_locks) {
    if (const int held = lock.exchange(0); held > 0) close(held - 1);
  }
}

void keep_from_children(int socket) {
  static const int told = pthread_atfork(nullptr, nullptr, let_go_in_child);
  static_cast<void>(told);
  for (auto& lock : g_locks) {
    int free = 0;
    if (lock.compare_exchange_strong(free, socket + 1)) return;
  }
}

void forget(int socket) {
  for (auto& lock : g_locks) {
    int held = socket + 1;
    if (lock.compare_exchange_strong(held, 0)) return;
  }
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
      keep_from_children(own);
      return InstanceLock{own};
    }
    if (const auto holder = holder_of(address)) {
      close(own);
      return refuse(holder->text);
    }
    std::this_thread::sleep_for(kPause);
  }
  close(own);
  return refuse("a process that does not say who it is");
}

Expected<void> InstanceLock::check(const std::string& name) {
  if (const auto holder = holder_of(Address{name})) return refuse(holder->text);
  return {};
}

std::vector<InstanceLock::Held> InstanceLock::held(const std::string& beginning) {
  const std::string ours = " @" + kOurs;  // behind the columns of numbers
  std::set<std::string> names;            // of those who listen and of those who have asked them
  std::ifstream sockets{"/proc/net/unix"};
  for (std::string line; std::getline(sockets, line);) {
    const std::size_t place = line.find(ours);
    if (place == std::string::npos) continue;
    std::string name = line.substr(place + ours.size());
    if (name.starts_with(beginning)) names.insert(std::move(name));
  }
  std::vector<Held> held;
  for (const std::string& name : names) {
    const auto holder = holder_of(Address{name});
    if (holder && holder->is_here) held.push_back({name, holder->pid});
  }
  return held;
}

InstanceLock::~InstanceLock() {
  if (socket_ < 0 || getpid() != owner_) return;
  forget(socket_);
  close(socket_);
}

}  // namespace armature
