// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugins/exit_guard.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "armature/runtime/plugins/running_code.hpp"

namespace armature {
namespace {

std::atomic<ExitGuard*> g_youngest{nullptr};

std::string text_of_exit(int code) {
  const RunningCode running = running_code();
  if (!running.name) {
    return fmt::format(
        "the process was ended by exit() (exit code {}) outside of a component's step", code);
  }
  return fmt::format("{} '{}' ended the process (exit code {}) in its {}", running.what,
                     running.name, code, running.phase);
}

}  // namespace

ExitGuard::ExitGuard(std::function<void(const std::string&)> tell)
    : tell_{std::move(tell)}, process_{getpid()}, outer_{g_youngest} {
  g_youngest = this;
  go_first();
}

ExitGuard::~ExitGuard() { g_youngest = outer_; }

void ExitGuard::go_first() {
  if (::on_exit(on_exit, nullptr) != 0) throw std::runtime_error("no memory for an exit handler");
}

void ExitGuard::on_exit(int code, void* /*data*/) {
  const ExitGuard* youngest = g_youngest;
  if (!youngest || youngest->process_ != getpid()) return;
  youngest->tell_(text_of_exit(code));
  _exit(EXIT_FAILURE);
}

}  // namespace armature
