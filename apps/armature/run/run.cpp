// SPDX-License-Identifier: Apache-2.0
#include "run/run.hpp"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "armature/runtime/deployment/deployment.hpp"
#include "armature/runtime/deployment_file/injected_fault.hpp"
#include "armature/runtime/deployment_file/on_fault.hpp"
#include "armature/runtime/plugins/exit_guard.hpp"
#include "armature/runtime/plugins/running_component.hpp"
#include "armature/runtime/processes/arm_ownership.hpp"
#include "armature/runtime/processes/child_processes.hpp"
#include "armature/runtime/processes/instance_lock.hpp"
#include "armature/runtime/reporting/output_folder.hpp"
#include "armature/runtime/reporting/run_report.hpp"
#include "colour.hpp"
#include "exit_code.hpp"
#include "inspect/plugins.hpp"
#include "run/console.hpp"
#include "run/end_signals.hpp"
#include "run/ending.hpp"
#include "run/host_agent.hpp"
#include "run/joint_reports.hpp"
#include "run/named_deployment.hpp"
#include "run/other_processes.hpp"
#include "run/report_list.hpp"
#include "run/run_recording.hpp"
#include "run/run_watches.hpp"
#include "run/watched_end.hpp"
#include "standard_output.hpp"
#include "terminal_text.hpp"

namespace armature {
namespace {

/// Makes the folder of the report, which is this run's as long as the lock is held. What an older
/// run left there is not this one's, however this one ends.
InstanceLock begin_report(const std::filesystem::path& folder) {
  prepare_output_folder(folder);
  auto lock = InstanceLock::take("report " + std::filesystem::canonical(folder).string());
  if (!lock) {
    throw std::runtime_error{
        fmt::format("another run writes its report into '{}' ({}); stop it, or give this one "
                    "another folder",
                    folder.string(), lock.error().text)};
  }
  for (const std::string& name : remove_listed_files(folder)) {
    fmt::print(
        stderr, "{} {} is of an older run into this folder; it stays, as it was changed since\n",
        coloured("warning:", Tone::doubtful, stderr), config::in_quotes((folder / name).string()));
  }
  remove_older(report_file(folder));
  remove_older(page_file(folder));
  end_signals::allow_report();
  return std::move(*lock);
}

/// Of a run that did not begin.
std::string_view status_of(const std::exception& error) {
  switch (exit_code_of(error)) {
    case kInvalidConfig: return "invalid_config";
    case kUnusablePlugin: return "unusable_plugin";
    default: return "not_started";
  }
}

bool report_written(const RunReport& report, const Deployment& deployment,
                    const std::filesystem::path& folder, ReportList& list, Console& console) {
  try {
    list.add_what([&] { write_report(report, deployment, folder); });
    return true;
  } catch (const std::runtime_error& error) {
    console.tell(error.what());
    return false;
  }
}

/// Prints the result. False: it could not be printed, as when the terminal is gone or the disk is
/// full.
bool result_printed(const RunOptions& options, const RunReport& report, Console& console) {
  const auto mark = [](std::string_view word, bool good) {
    return coloured(word, good ? Tone::good : Tone::bad, standard_output());
  };
  const auto quote = [](std::string_view text) { return terminal_lines(text, 4); };
  const std::string text = options.json ? to_json(report) + "\n" : to_table(report, mark, quote);
  const bool printed =
      std::fputs(text.c_str(), standard_output()) >= 0 && std::fflush(standard_output()) == 0;
  if (!printed) {
    console.tell(
        fmt::format("the result was not printed: {}", std::generic_category().message(errno)));
  }
  return printed;
}

int conclude(const RunOptions& options, const Deployment& deployment, const RunReport& report,
             ReportList& list, Console& console, WatchedEnd& end) {
  const bool printed = result_printed(options, report, console);
  end.result_told();
  end_signals::result_told();
  const bool written =
      !options.report || report_written(report, deployment, *options.report, list, console);
  return printed && written && report.status() == "ok" ? kOk : kFailed;
}

/// Writes the list of the files of the report, once all are there. False: it could not be written.
bool is_listed(const RunOptions& options, const DeploymentConfig& config, ReportList& list,
               Console& console) {
  list.add(page_file(*options.report).filename());
  if (options.records_for_page) list.add(kRecordingForPage);
  for (const std::string& table : joint_tables(config)) list.add(table);
  try {
    list.write();
    return true;
  } catch (const std::runtime_error& error) {
    console.tell(error.what());
    return false;
  }
}

/// What failed in a process that does not judge the deployment's goals, or "".
std::string fault_of(const Deployment& deployment, const ChildWatch& watch) {
  if (std::string fault = deployment.fault(); !fault.empty()) return fault;
  if (!deployment.hangs().empty()) return deployment.hangs().front();
  if (const auto isolated = deployment.isolated_faults(); !isolated.empty()) {
    return isolated.front();
  }
  if (const auto silent = deployment.silent(); !silent.empty()) return silent.front();
  return watch.interruption().value_or("");
}

/// The main process that was started by hand has the figures of the run, and judges its goals.
int conclude_main_by_hand(const RunOptions& options, const Deployment& deployment,
                          const ChildWatch& watch, Console& console, WatchedEnd& end) {
  RunReport::Ending ending{.faults = {}, .stopped = watch.interruption()};
  if (options.timing) ending.timing = timing_of(deployment);
  const RunReport report{deployment, ending};
  const bool printed = result_printed(options, report, console);
  end.result_told();
  end_signals::result_told();
  return printed && report.status() == "ok" ? kOk : kFailed;
}

/// Hears from the components of a process that tells no figures only whether the scenario failed.
class OnlyFailure final : public Summary {
 public:
  void metric(std::string, std::string, double) override {}
  void series(std::string, std::string, std::vector<double>) override {}
  void text(std::string, std::string, std::string) override {}
  void not_measured(std::string, std::string, std::string) override {}
  void does_not_apply(std::string, std::string, std::string) override {}
  void failed(std::string status, std::string reason) override {
    failed_ = {std::move(status), std::move(reason)};
  }
  const std::optional<std::pair<std::string, std::string>>& failed() const { return failed_; }

 private:
  std::optional<std::pair<std::string, std::string>> failed_;
};

/// Tells the main process how this one's components say that the run went. Without a main process
/// that a scenario failed is this one's own fault: why, or "".
std::string tell_outcome(const Deployment& deployment, ChildWatch& watch) {
  for (const std::string& unwell : deployment.unwell()) watch.tell("unwell", unwell);
  OnlyFailure summary;
  for (const auto& runner : deployment.runners()) {
    if (deployment.is_hung(*runner)) continue;
    deployment.tell_ending("summary", *runner);
    runner->summarize(summary);
  }
  const auto& failed = summary.failed();
  if (!failed) return "";
  watch.tell("failed", failed->first + " " + failed->second);
  return watch.alone() ? "the scenario failed: " + failed->second : "";
}

/// Writes this process' files into the folder of the main one's report. Why it could not, or "".
std::string write_report_files(const Deployment& deployment, const std::filesystem::path& folder,
                               ChildWatch& watch, WatchedEnd& end) {
  ReportList list{folder};
  std::string failed;
  watch.tell("writing", folder.string());
  end.do_unwatched(
      [&] { list.add_what([&] { failed = write_component_files(deployment, folder); }); });
  for (const std::string& name : list.names()) watch.tell("wrote", name);
  return failed;
}

int conclude_child(const RunOptions& options, const Deployment& deployment, ChildWatch& watch,
                   WatchedEnd& end) {
  const std::string failed = tell_outcome(deployment, watch);
  std::string fault = fault_of(deployment, watch);
  if (fault.empty()) fault = failed;
  if (!options.report_files.empty()) {
    const std::string unwritten = write_report_files(deployment, options.report_files, watch, end);
    if (fault.empty()) fault = unwritten;
  }
  watch.tell_fault(fault);
  if (options.timing) watch.tell_timing(timing_of(deployment));
  if (options.json) print_out("{}", ending(fault.empty() ? "ok" : "fault", fault));
  end.result_told();
  return fault.empty() ? kOk : kFailed;
}

/// Leaves the process where it stands when a step still runs, or when the transport might not
/// survive its own end because the system clock was stepped. Everything else has been closed.
void leave_if_necessary(const Deployment& deployment, const ProcessWatch& watch, int code) {
  if (deployment.hung().empty() && !watch.clock_was_stepped()) return;
  if (std::fflush(standard_output()) != 0) code = kFailed;
  _exit(code);
}

/// What a process of a deployment is made from.
struct Process {
  std::string name;
  int domain;
  Network network;
  RunOptions::Origin origin;
  std::filesystem::path folder;  // that it was started in
};

/// Undoes what a plugin has done to the process' folder: the files of the end, which are named from
/// there, stand where the run was started.
void go_back_to(const std::filesystem::path& folder, Console& console) {
  std::error_code lost;
  const auto here = std::filesystem::current_path(lost);
  if (lost || folder.empty() || here == folder) return;
  std::filesystem::current_path(folder, lost);
  if (lost) return;  // it was renamed or removed
  console.tell(
      fmt::format("a plugin has changed the folder that the process works in, to '{}'; it "
                  "is changed back",
                  here.string()));
}

/// The name of a run: all of its processes have it, and no other run. Where the clock is simulated
/// all begin at one time.
std::string new_run() { return fmt::format("{:x}-{:x}", SystemClock{}.now().ns, getpid()); }

void tell_network(const Network& network, Console& console) {
  if (to_text(network) == to_text(Network{})) return;
  console.line("runtime", fmt::format("DDS joins {}{}", to_text(network),
                                      network.joined.empty()
                                          ? ""
                                          : ". Programs there may read every topic, and only DDS "
                                            "Security helps against one that copies the "
                                            "fingerprint"));
}

/// Has the black box written for a run that ends with another status than ok though no component
/// was unwell: a task refused, a goal was missed.
void tell_status_to_black_box(const std::string& status, Deployment& deployment) {
  const auto& record = deployment.config().record;
  if (!record || !record->around_faults || status == "ok") return;
  deployment.tell(fmt::format("the run ends with status '{}'", status),
                  StatusReporter::State::degraded);
}

int run_main(const RunOptions& options, const Process& process, Deployment& deployment,
             PluginRegistry& plugins, Console& console, WatchedEnd& end) {
  check_recordings(deployment.config(), process.origin.start);
  ChildProcesses children;
  start_processes(children, options, deployment.config(), process.domain, process.origin);
  deployment.connect(plugins, process.domain, process.origin.run);
  const auto recording = begin_recording(deployment, process.name, process.origin.start);
  tell_network(process.network, console);
  expect_hosts(children, options, deployment, process.origin);
  MainWatch watch{console, children, deployment};
  try {
    deployment.run(watch);
  } catch (...) {
    if (recording && !watch.started()) {
      children.end([](const std::string&) { return true; });  // one may begin its own only now
      remove_recordings(*recording, deployment.config());
    }
    throw;
  }
  go_back_to(process.folder, console);
  RunReport::Ending ending{.faults = watch.end_all(),
                           .unwell = children.unwell(),
                           .failed = children.failed(),
                           .stopped = watch.interruption()};
  // Somebody has looked at it for long enough: that is how such a run ends.
  if (options.keep_running && deployment.scenario_over() && ending.stopped == "interrupted") {
    ending.stopped.reset();
  }
  RunTiming timing;
  if (wants_timing(options, deployment.config())) {
    timing = timing_of(deployment);
    children.add_timing(timing);
  }
  if (options.timing) ending.timing = timing;
  const RunReport report{deployment, ending};
  ReportList list{options.report.value_or("")};
  for (const std::string& name : children.written()) list.add(name);
  int code = conclude(options, deployment, report, list, console, end);
  tell_status_to_black_box(report.status(), deployment);
  if (!deployment.end_recording(figures_json(report, timing))) code = kFailed;
  end.do_unwatched([&] {
    if (recording && !joined(*recording, deployment.config(), console)) code = kFailed;
    if (options.report && !page_written(recording, *options.report, console)) code = kFailed;
    if (options.report && !is_listed(options, deployment.config(), list, console)) code = kFailed;
  });
  for (const std::string& fault : ending.faults) console.tell(fault);
  if (ending.stopped) console.tell(*ending.stopped);
  console.flush();
  leave_if_necessary(deployment, watch, code);
  return code;
}

int run_other(const RunOptions& options, const Process& process, Deployment& deployment,
              PluginRegistry& plugins, Console& console, ChildWatch& watch, WatchedEnd& end) {
  check_recording(deployment.config(), process.name, process.origin.start);
  deployment.connect(plugins, process.domain, process.origin.run);
  const auto recording = begin_recording(deployment, process.name, process.origin.start);
  watch.set_deployment(deployment);
  try {
    deployment.run(watch);
  } catch (...) {
    if (recording && !watch.started()) remove_older(*recording);
    throw;
  }
  go_back_to(process.folder, console);
  int code = process.name == kMainProcess
                 ? conclude_main_by_hand(options, deployment, watch, console, end)
                 : conclude_child(options, deployment, watch, end);
  if (!deployment.end_recording()) {
    watch.tell_fault("its recording has no end");
    code = kFailed;
  }
  console.flush();
  leave_if_necessary(deployment, watch, code);
  return code;
}

/// `what` is "process" or "host", and `names` are those of the deployment.
void check_name(const DeploymentConfig& config, const char* what, const std::string& name,
                const std::vector<std::string>& names) {
  if (std::ranges::find(names, name) != names.end()) return;
  throw InvalidChoice(fmt::format("deployment '{}' has no {} '{}'{}", config.name, what, name,
                                  config::did_you_mean(name, names)));
}

/// The first line of a run. It comes before the components are made, which may take seconds.
std::string starting_text(const DeploymentConfig& config) {
  const std::ptrdiff_t count = count_components(config);
  return fmt::format("starting {}: {} component{}", config.name, count, count == 1 ? "" : "s");
}

int run(RunOptions options) {
  const bool is_child = !options.process.empty();
  std::error_code no_folder;
  // Another process of a deployment just ends: its main process tells, and asks it for no JSON.
  if (!is_child || options.json) end_signals::end_before_start();
  if (is_child && options.control >= 0) prctl(PR_SET_PDEATHSIG, SIGKILL);  // until it can listen
  std::optional<InstanceLock> report_lock;
  if (options.report) report_lock.emplace(begin_report(*options.report));
  PluginRegistry plugins;
  if (!is_child) tell_warnings(plugins);
  std::vector<std::string> notes;
  DeploymentConfig config = read_named(options.source, plugins, &notes);
  if (!is_child) {
    for (const std::string& note : notes)
      fmt::print(stderr, "{} {}\n", coloured("warning:", Tone::doubtful, stderr), note);
  }
  Process process{.name = is_child ? options.process : std::string{kMainProcess},
                  .domain = options.domain.value_or(config.domain),
                  .network = find_network(config.dds),
                  .origin = options.origin.value_or(
                      RunOptions::Origin{SystemClock{}.unix_minus_monotonic(), Time{}}),
                  .folder = std::filesystem::current_path(no_folder)};
  check_name(config, "process", process.name, config.processes());
  check_name(config, "host", options.host, config.hosts());
  if (is_child && options.control < 0 && config.hosts().size() > 1) {
    const std::string host = config.host_of(process.name);
    throw InvalidChoice(fmt::format(
        "process '{}' is on host '{}', and hosts go by one clock, which no process can measure for "
        "itself: run the file there with {}",
        process.name, host,
        host == kMainHost ? "no --process" : fmt::format("--host {} and no --process", host)));
  }
  if (options.host != kMainHost) {
    const int code = run_host(options, config, process.domain, plugins);
    if (options.json) print_out("{}", ending(code == kOk ? "ok" : "fault", ""));
    return code;
  }
  const std::vector<InstanceLock> locks = own_arms(config, process.name, process.domain);
  const std::string starting = starting_text(config);
  if (options.report) {
    add_joint_reports(config, plugins, *options.report);
    if (!config.record) record_for_page(config, options);
  }
  if (options.keep_running && config.simulated) {
    throw InvalidChoice(
        "--keep-running is for watching, and a run on the simulated clock is as "
        "fast as the machine allows; add --set clock=system");
  }

  std::optional<InjectedFault> injected;
  if (options.inject) {
    injected = InjectedFault::read(*options.inject, config);
    InjectedFault::listen();
  }
  Console console;
  std::optional<ChildWatch> child_watch;
  if (is_child) child_watch.emplace(console, options.control);
  WatchedEnd end{options, console, is_child ? &*child_watch : nullptr};
  const ExitGuard guard{[&](const std::string& what) { end.leave(what); }};
  name_crashing_components();
  if (!is_child) console.line("runtime", starting);
  Deployment deployment{
      std::move(config),
      plugins,
      {.process = process.name,
       .on_line = [&](const auto& who, const auto& text) { console.line(who, text); },
       .on_note = [&](const auto& text) { console.line("runtime", text); },
       .clock_offset = process.origin.clock_offset,
       .keeps_running = options.keep_running,
       .on_ending = [&](const auto& what) { end.begin(what); },
       .domain = process.domain}};
  if (injected) deployment.inject(*injected);
  ExitGuard::go_first();
  end_signals::stop_in_order();
  if (is_child && options.control >= 0) prctl(PR_SET_PDEATHSIG, 0);
  if (!options.origin) process.origin.start = deployment.clock().now();
  if (!is_child) process.origin.run = new_run();
  console.start(deployment.clock(), process.origin.start);
  return is_child ? run_other(options, process, deployment, plugins, console, *child_watch, end)
                  : run_main(options, process, deployment, plugins, console, end);
}

}  // namespace

int run_deployment(const RunOptions& options) {
  umask(077);                        // what a run writes is about a patient
  std::signal(SIGXFSZ, [](int) {});  // whoever writes a file that may grow no further tells it
  end_signals::say(
      {.json = options.json, .report_file = options.report ? report_file(*options.report) : ""});
  try {
    return run(options);
  } catch (const std::exception& error) {
    if (end_signals::is_result_told()) throw;
    const std::string told = ending(status_of(error), error.what());
    if (options.json) print_out("{}", told);
    if (end_signals::report_allowed()) write_ending(*options.report, told);
    throw;
  }
}

}  // namespace armature
