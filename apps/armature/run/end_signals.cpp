// SPDX-License-Identifier: Apache-2.0
#include "run/end_signals.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <string_view>
#include <vector>

#include "armature/values/inline_text.hpp"
#include "exit_code.hpp"
#include "standard_output.hpp"

namespace armature::end_signals {
namespace {

/// Of an operator, who may lose timeout: several of them end the process at once.
constexpr std::array kOfOperator{SIGINT, SIGTERM, SIGQUIT};

std::atomic<int> g_signal{0}, g_count{0}, g_of_operator{0};
bool g_hangs_up = false;
std::atomic<bool> g_json{false}, g_reports{false}, g_result_told{false};
std::string g_report_file;  // set before any handler

bool is_of_operator(int signal) {
  return std::ranges::find(kOfOperator, signal) != kOfOperator.end();
}

/// Every signal that ends a process which does not handle it, but those of a crash, those that
/// cannot be handled, SIGPIPE and SIGXFSZ; and Ctrl-Z, which would halt it with a moving arm.
std::vector<int> all_end_signals() {
  std::vector<int> all{kOfOperator.begin(), kOfOperator.end()};
  all.insert(all.end(), {SIGHUP, SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGIO, SIGPWR,
                         SIGSTKFLT, SIGXCPU, SIGTSTP});
  for (int signal = SIGRTMIN; signal <= SIGRTMAX; ++signal) all.push_back(signal);
  return all;
}

using Text = InlineText<160>;

/// In a signal handler, too: without memory of its own.
Text text_of(int signal) {
  switch (signal) {
    case SIGINT: return "interrupted";
    case SIGTERM: return "terminated";
    case SIGHUP: return "the terminal was closed";
    default: break;
  }
  if (const char* name = sigabbrev_np(signal)) return Text::format("ended by SIG{}", name);
  return Text::format("ended by signal {}", signal);
}

/// In a signal handler, which may open and write, and little else.
[[noreturn]] void leave(std::string_view json, std::string_view line) {
  if (g_json && !g_result_told) write_at_once(standard_output_descriptor(), json);
  if (g_reports && !g_result_told) {
    const int report =
        ::open(g_report_file.c_str(),
               O_WRONLY | O_CREAT | O_TRUNC | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (report >= 0) write_at_once(report, json);
  }
  write_at_once(STDERR_FILENO, line);
  _exit(kFailed);
}

void on_signal_before_start(int signal) {
  const Text text = text_of(signal);
  leave(Text::format("{{\"status\":\"not_started\",\"reason\":\"{} before the start\"}}\n",
                     text.view())
            .view(),
        Text::format("armature: {} before the start\n", text.view()).view());
}

void on_signal(int signal) {
  // A terminal that is closed may say so several times, and so may a timer, and a limit.
  if (!is_of_operator(signal) && g_count > 0) return;
  if (++g_count == 1) g_signal = signal;
  if (!is_of_operator(signal) || ++g_of_operator < 3) return;
  if (g_result_told)
    leave("", "armature: ended at once by a third signal; its recording is not finished\n");
  leave(
      "{\"status\":\"fault\",\"reason\":\"ended at once by a third signal, before everything was "
      "at rest\"}\n",
      "armature: ended at once by a third signal, before everything was at rest\n");
}

void handle(void (*handler)(int)) {
  for (const int signal : all_end_signals()) {
    struct sigaction now {};
    sigaction(signal, nullptr, &now);
    const auto set = now.sa_handler;
    // Else somebody ignores it, as under nohup, or uses it, as a profiler or a drill does.
    const bool is_free = set == SIG_DFL || set == on_signal_before_start || is_of_operator(signal);
    if (is_free) std::signal(signal, handler);
  }
}

}  // namespace

void say(const Words& words) {
  g_json = words.json;
  g_report_file = words.report_file.string();
}
void allow_report() { g_reports = true; }
bool report_allowed() { return g_reports; }
void result_told() { g_result_told = true; }
bool is_result_told() { return g_result_told; }

void end_before_start() { handle(on_signal_before_start); }

void stop_in_order() {
  handle(on_signal);
  struct sigaction now {};
  sigaction(SIGHUP, nullptr, &now);
  g_hangs_up = now.sa_handler == on_signal;
  // No SIG_IGN, which the programs that a plugin starts would inherit.
  std::signal(SIGPIPE, [](int) {});
  std::signal(SIGTTOU, SIG_IGN);  // in the background it writes on, and is not halted
}

std::string take_back() {
  std::string first;
  for (const int signal : {SIGINT, SIGTERM, SIGQUIT, SIGHUP}) {
    struct sigaction now {};
    sigaction(signal, nullptr, &now);
    // Under nohup nobody listens to SIGHUP.
    if (now.sa_handler == on_signal || (signal == SIGHUP && !g_hangs_up)) continue;
    std::signal(signal, on_signal);
    if (first.empty()) first = fmt::format("SIG{}", sigabbrev_np(signal));
  }
  return first;
}

std::optional<std::string> cause() {
  const int signal = g_signal;
  if (signal == 0) return std::nullopt;
  return std::string{text_of(signal).view()};
}
int count() { return g_count; }

}  // namespace armature::end_signals
