// SPDX-License-Identifier: Apache-2.0
#include "standard_output.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>

namespace armature {
namespace {

std::atomic<int> g_descriptor{STDOUT_FILENO};
std::FILE* g_own = nullptr;

}  // namespace

std::FILE* standard_output() { return g_own ? g_own : stdout; }

int standard_output_descriptor() { return g_descriptor; }

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
