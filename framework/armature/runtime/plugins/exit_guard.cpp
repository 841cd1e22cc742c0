// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugins/exit_guard.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <utility>

#include "armature/runtime/plugins/running_code.hpp"

namespace armature {
namespace {

std::atomic<ExitGuard*> g_youngest{nullptr};

/// In place of an exit code, which quick_exit() tells nobody.
constexpr int kQuickExit = std::numeric_limits<int>::min();

std::string text_of_exit(int code) {
  const std::string how = code == kQuickExit ? "quick_exit()" : fmt::format("exit code {}", code);
  const RunningCode running = running_code();
  if (!running.name) {
    return fmt::format("the process was ended ({}) outside of a component's step", how);
  }
  return fmt::format("{} '{}' ended the process ({}) in its {}", running.what, running.name, how,
                     running.phase);
}

}  // namespace

ExitGuard::ExitGuard(std::function<void(const std::string&)> tell)
    : tell_{std::move(tell)}, process_{getpid()}, outer_{g_youngest} {
  g_youngest = this;
  go_first();
}

ExitGuard::~ExitGuard() { g_youngest = outer_; }

void ExitGuard::go_first() {
  const bool known = ::on_exit(on_exit, nullptr) == 0 &&
                     std::at_quick_exit([] { on_exit(kQuickExit, nullptr); }) == 0;
  if (!known) throw std::runtime_error("no memory for an exit handler");
}

void ExitGuard::on_exit(int code, void* /*data*/) {
  const ExitGuard* youngest = g_youngest;
  if (!youngest || youngest->process_ != getpid()) return;
  youngest->tell_(text_of_exit(code));
  _exit(EXIT_FAILURE);
}

}  // namespace armature
