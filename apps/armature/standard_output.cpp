// SPDX-License-Identifier: Apache-2.0
#include "standard_output.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>

namespace armature {
namespace {

std::atomic<int> g_descriptor{STDOUT_FILENO};
std::FILE* g_own = nullptr;

}  // namespace

std::FILE* standard_output() { return g_own ? g_own : stdout; }

int standard_output_descriptor() { return g_descriptor; }

void write_at_once(int file, std::string_view text) {
  pollfd writable{.fd = file, .events = POLLOUT, .revents = 0};
  if (poll(&writable, 1, 0) <= 0) return;
  [[maybe_unused]] const auto written = ::write(file, text.data(), text.size());
}

void keep_standard_output() {
  std::fflush(stdout);
  const int own = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  std::FILE* const file = own < 0 ? nullptr : fdopen(own, "w");
  if (!file) return;  // no descriptor is free: all print on the same one
  g_own = file;
  g_descriptor = own;
  dup2(STDERR_FILENO, STDOUT_FILENO);
  setvbuf(stdout, nullptr, _IOLBF, 0);  // in order with what else is told there
}

}  // namespace armature
