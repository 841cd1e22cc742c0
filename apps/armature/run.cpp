// SPDX-License-Identifier: Apache-2.0
#include "run.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <string_view>

#include "armature/config/document.hpp"
#include "armature/runtime/child_processes.hpp"
#include "armature/runtime/deployment.hpp"
#include "armature/runtime/instance_lock.hpp"
#include "armature/runtime/run_report.hpp"
#include "exit_code.hpp"

namespace armature {
namespace {

std::atomic<int> g_signal{0};

void on_signal(int signal) {
  g_signal = signal;
  std::signal(signal, SIG_DFL);  // the second one ends the process at once
}

/// Before the components run there is nothing to end in order, and constructing them (a landmark
/// model is read) cannot be told to stop: the process ends at once.
void end_before_start(int signal) {
  const std::string_view text = signal == SIGINT ? "armature: interrupted before the start\n"
                                                 : "armature: terminated before the start\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
  _exit(kFailed);
}

/// What ends a run in order: Ctrl-C, `kill`, and a terminal that is closed (but under nohup).
void on_end_signals(void (*handler)(int)) {
  std::signal(SIGINT, handler);
  std::signal(SIGTERM, handler);
  if (std::signal(SIGHUP, SIG_IGN) != SIG_IGN) std::signal(SIGHUP, handler);
}

/// Lines for the operator, with the deployment's time; from any thread.
class Console {
 public:
  void start(const Clock& clock) {
    clock_ = &clock;
    start_ = clock.now();
  }
  void line(const std::string& who, const std::string& text) {
    const std::scoped_lock lock{mutex_};
    const double time = clock_ ? to_seconds(clock_->now() - start_) : 0.0;
    fmt::print(stderr, "[{:7.3f} s] {:<9} {}\n", time, who, text);
  }

 private:
  const Clock* clock_ = nullptr;
  Time start_;
  std::mutex mutex_;
};

std::vector<std::string> child_arguments(const RunOptions& options, int domain,
                                         const std::string& process) {
  std::vector<std::string> arguments{"run", "--process", process, "--domain",
                                     std::to_string(domain)};
  for (const auto& assignment : options.source.assignments) {
    arguments.insert(arguments.end(), {"--set", assignment});
  }
  for (const auto& file : options.source.files) arguments.push_back(file.string());
  return arguments;
}

/// Runs the deployment to its end; a line when one of its other processes ended before.
std::optional<std::string> run_to_end(Deployment& deployment, ChildProcesses& children) {
  std::optional<std::string> lost;
  deployment.run([&] {
    if (!lost) lost = children.ended();
    return lost || g_signal != 0;
  });
  children.stop();
  return lost;
}

int conclude(const RunOptions& options, const Deployment& deployment,
             const std::optional<std::string>& lost) {
  std::optional<std::string> stopped;
  if (g_signal != 0) stopped = g_signal == SIGINT ? "interrupted" : "terminated";
  const RunReport report{deployment, {.lost_process = lost, .stopped = stopped}};
  if (options.json) {
    fmt::print("{}\n", to_json(report));
  } else {
    fmt::print("{}", to_table(report));
  }
  std::fflush(stdout);
  if (options.report) write_report(report, deployment, *options.report);
  if (lost) fmt::print(stderr, "armature: {}\n", *lost);
  if (stopped) fmt::print(stderr, "armature: {}\n", *stopped);
  return report.status() == "ok" ? kOk : kFailed;
}

}  // namespace

int run_deployment(const RunOptions& options) {
  const bool is_child = !options.process.empty();
  if (!is_child) {  // another process of a deployment just ends: its main process tells
    on_end_signals(end_before_start);
  }
  // A folder that cannot be written is told before the run, not after it.
  if (options.report) std::filesystem::create_directories(*options.report);
  PluginRegistry plugins;
  config::Problems problems;
  DeploymentConfig config =
      read_deployment(config::load_with_overlays(options.source.files, options.source.assignments),
                      plugins, problems);
  problems.throw_if_any();
  const int domain = options.domain.value_or(config.domain);
  const std::string process = is_child ? options.process : std::string{kMainProcess};
  const std::vector<std::string> processes = config.processes();
  if (std::find(processes.begin(), processes.end(), process) == processes.end()) {
    throw InvalidChoice(fmt::format("deployment '{}' has no process '{}'{}", config.name, process,
                                    config::did_you_mean(process, processes)));
  }

  std::optional<InstanceLock> lock;
  if (!is_child) {
    auto taken = InstanceLock::take(config.name, domain);
    if (!taken) {
      fmt::print(stderr, "armature: {}\n", taken.error().text);
      return kFailed;
    }
    lock.emplace(std::move(*taken));
  }
  Console console;
  Deployment deployment{
      std::move(config),
      plugins,
      {.process = process,
       .on_line = [&](const auto& who, const auto& text) { console.line(who, text); },
       .on_note = [&](const auto& text) { console.line("runtime", text); }}};
  on_end_signals(on_signal);
  // Before any thread: a child is forked from a process that has only this one.
  ChildProcesses children;
  if (!is_child) {
    for (const auto& other : processes) {
      if (other != kMainProcess) children.start(other, child_arguments(options, domain, other));
    }
  }
  console.start(deployment.clock());
  deployment.connect(plugins, domain);
  const auto lost = run_to_end(deployment, children);
  if (is_child) return deployment.fault().empty() ? kOk : kFailed;
  return conclude(options, deployment, lost);
}

}  // namespace armature
