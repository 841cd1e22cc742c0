// SPDX-License-Identifier: Apache-2.0
#include "run.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <exception>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "armature/config/document.hpp"
#include "armature/runtime/child_processes.hpp"
#include "armature/runtime/deployment.hpp"
#include "armature/runtime/instance_lock.hpp"
#include "armature/runtime/output_folder.hpp"
#include "armature/runtime/run_report.hpp"
#include "armature/runtime/write_atomically.hpp"
#include "exit_code.hpp"

namespace armature {
namespace {

std::atomic<int> g_signal{0};
std::atomic<bool> g_json{false};
std::atomic<pid_t> g_process{0};
std::string g_report_file;           // report.json; set before any handler
std::atomic<bool> g_reports{false};  // from when that can be written

void on_signal(int signal) {
  g_signal = signal;
  std::signal(signal, SIG_DFL);  // the second one ends the process at once
}

/// Before the components run there is nothing to end in order, and constructing them (a landmark
/// model is read) cannot be told to stop: the process ends at once.
void end_before_start(int signal) {
  // Ctrl-C reaches the fork in which a library is tried, too; it has nothing to say.
  if (getpid() != g_process) _exit(kFailed);
  const auto write_out = [](int file, std::string_view text) {
    [[maybe_unused]] const auto written = ::write(file, text.data(), text.size());
  };
  const bool interrupted = signal == SIGINT;
  const std::string_view ending =
      interrupted ? R"({"status":"not_started","reason":"interrupted before the start"})"
                    "\n"
                  : R"({"status":"not_started","reason":"terminated before the start"})"
                    "\n";
  if (g_json) write_out(STDOUT_FILENO, ending);
  if (g_reports) {
    // A signal handler may open and write, and little else; not wait for a pipe's reader either.
    const int report =
        ::open(g_report_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NONBLOCK | O_CLOEXEC, 0666);
    if (report >= 0) write_out(report, ending);
  }
  write_out(STDERR_FILENO, interrupted ? "armature: interrupted before the start\n"
                                       : "armature: terminated before the start\n");
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

/// Runs the deployment to its end, which may be told in another process; a line when one of them
/// was lost.
std::optional<std::string> run_to_end(Deployment& deployment, ChildProcesses& children) {
  std::optional<ChildProcesses::Ending> ended;
  deployment.run([&] {
    if (!ended) ended = children.ended();
    return ended || g_signal != 0;
  });
  children.stop();
  if (!ended || ended->well) return std::nullopt;
  return ended->text;
}

/// As JSON, what there is to say of a run without figures.
std::string ending(std::string_view status, const std::string& reason) {
  nlohmann::ordered_json json{{"status", status}};
  if (!reason.empty()) json["reason"] = reason;
  // What is wrong may quote a file that is no UTF-8.
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
}

/// Makes the folder of the report. What an older run left there is not this one's, however this one
/// ends.
void begin_report(const std::filesystem::path& folder) {
  prepare_output_folder(folder);
  std::error_code none;
  const auto older = std::filesystem::symlink_status(g_report_file, none);
  if (std::filesystem::is_regular_file(older)) std::filesystem::remove(g_report_file, none);
  g_reports = true;
}

/// What a run that did not begin says, where its report would be.
void write_ending(const std::string& ending) {
  try {
    write_atomically(g_report_file, ending);
  } catch (const std::runtime_error& error) {
    fmt::print(stderr, "armature: {}\n", error.what());
  }
}

/// Of a run that did not begin.
std::string_view status_of(const std::exception& error) {
  switch (exit_code_of(error)) {
    case kInvalidConfig:
      return "invalid_config";
    case kUnusablePlugin:
      return "unusable_plugin";
    default:
      return "not_started";
  }
}

bool report_written(const RunReport& report, const Deployment& deployment,
                    const std::filesystem::path& folder) {
  try {
    write_report(report, deployment, folder);
    return true;
  } catch (const std::runtime_error& error) {
    fmt::print(stderr, "armature: {}\n", error.what());
    return false;
  }
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
  if (lost) fmt::print(stderr, "armature: {}\n", *lost);
  if (stopped) fmt::print(stderr, "armature: {}\n", *stopped);
  if (options.report && !report_written(report, deployment, *options.report)) return kFailed;
  return report.status() == "ok" ? kOk : kFailed;
}

/// Of a process that does not judge the deployment's goals. To the main one, which waits for it, 0
/// says that the story has been told.
int conclude_child(const RunOptions& options, const Deployment& deployment) {
  const std::string fault = deployment.fault();
  if (options.json) fmt::print("{}", ending(fault.empty() ? "ok" : "fault", fault));
  return fault.empty() && g_signal == 0 ? kOk : kFailed;
}

int run(const RunOptions& options) {
  const bool is_child = !options.process.empty();
  // Another process of a deployment just ends: its main process tells, and asks it for no JSON.
  if (!is_child || options.json) on_end_signals(end_before_start);
  if (options.report && !is_child) begin_report(*options.report);
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
    if (!taken) throw std::runtime_error{taken.error().text};
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
  return is_child ? conclude_child(options, deployment) : conclude(options, deployment, lost);
}

}  // namespace

int run_deployment(const RunOptions& options) {
  g_json = options.json;
  g_process = getpid();
  if (options.report) g_report_file = *options.report / "report.json";
  try {
    return run(options);
  } catch (const std::exception& error) {
    const std::string told = ending(status_of(error), error.what());
    if (options.json) fmt::print("{}", told);
    if (g_reports) write_ending(told);
    throw;
  }
}

}  // namespace armature
