// SPDX-License-Identifier: Apache-2.0
#include "end_signals.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <string_view>

#include "exit_code.hpp"

namespace armature::end_signals {
namespace {

std::atomic<int> g_signal{0}, g_count{0};
std::atomic<bool> g_json{false}, g_reports{false};
std::string g_report_file;  // set before any handler

/// Never waits for a reader.
void write_out(int file, std::string_view text) {
  pollfd writable{.fd = file, .events = POLLOUT, .revents = 0};
  if (poll(&writable, 1, 0) <= 0) return;
  [[maybe_unused]] const auto written = ::write(file, text.data(), text.size());
}

/// In a signal handler, which may open and write, and little else.
[[noreturn]] void leave(std::string_view json, std::string_view line) {
  if (g_json) write_out(STDOUT_FILENO, json);
  if (g_reports) {
    const int report =
        ::open(g_report_file.c_str(),
               O_WRONLY | O_CREAT | O_TRUNC | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (report >= 0) write_out(report, json);
  }
  write_out(STDERR_FILENO, line);
  _exit(kFailed);
}

void on_signal_before_start(int signal) {
  if (signal == SIGINT) {
    leave("{\"status\":\"not_started\",\"reason\":\"interrupted before the start\"}\n",
          "armature: interrupted before the start\n");
  }
  if (signal == SIGHUP) {
    leave("{\"status\":\"not_started\",\"reason\":\"the terminal was closed before the start\"}\n",
          "armature: the terminal was closed before the start\n");
  }
  leave("{\"status\":\"not_started\",\"reason\":\"terminated before the start\"}\n",
        "armature: terminated before the start\n");
}

void on_signal(int signal) {
  // A terminal that is closed may say so several times.
  if (signal == SIGHUP && g_count > 0) return;
  const int count = ++g_count;
  if (count == 1) g_signal = signal;
  if (count < 3) return;
  leave(
      "{\"status\":\"fault\",\"reason\":\"ended at once by a third signal, before everything was "
      "at rest\"}\n",
      "armature: ended at once by a third signal, before everything was at rest\n");
}

void handle(void (*handler)(int)) {
  std::signal(SIGINT, handler);
  std::signal(SIGTERM, handler);
  if (std::signal(SIGHUP, SIG_IGN) != SIG_IGN) std::signal(SIGHUP, handler);
}

}  // namespace

void say(const Words& words) {
  g_json = words.json;
  g_report_file = words.report_file.string();
}
void allow_report() { g_reports = true; }
bool report_allowed() { return g_reports; }

void end_before_start() { handle(on_signal_before_start); }

void stop_in_order() {
  handle(on_signal);
  // No SIG_IGN, which the programs that a plugin starts would inherit.
  std::signal(SIGPIPE, [](int) {});
}

std::optional<std::string> cause() {
  switch (g_signal) {
    case 0:
      return std::nullopt;
    case SIGINT:
      return "interrupted";
    case SIGHUP:
      return "the terminal was closed";
    default:
      return "terminated";
  }
}
int count() { return g_count; }

}  // namespace armature::end_signals
