// SPDX-License-Identifier: Apache-2.0
#include "bench/watched/bench_watched.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "armature/bus/topic_name.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"
#include "bench/pause.hpp"
#include "bench/program.hpp"
#include "bench/watched/watched_report.hpp"
#include "exit_code.hpp"
#include "progress.hpp"
#include "run/named_deployment.hpp"
#include "standard_output.hpp"
#include "watch/outsider.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;
using bench::Program;
using bench::WatchedReport;
using bench::WatchedRound;
using bench::WatchedRun;
using bench::Watching;

/// Linux cuts a thread's name there.
constexpr std::size_t kThreadName = 15;

/// What the bench knows of a deployment before it runs.
struct Subject {
  std::vector<std::string> measured;  // topics of what is measured: "/dental_lamp/arm/measured_js"
  std::vector<std::string> executors;
};

Subject subject_of(const DeploymentSource& source) {
  PluginRegistry plugins;
  const DeploymentConfig config = read_named(source, plugins);
  if (config.simulated) {
    throw InvalidChoice("on the simulated clock nobody waits for a watcher: --set clock=system");
  }
  if (config.record) {
    throw InvalidChoice("the bench itself says what is recorded: leave record: out");
  }
  if (config.processes().size() > 1) {
    throw InvalidChoice("what a deployment in several processes costs is not measured here");
  }
  Subject subject;
  for (const ExecutorSpec& executor : config.executors) subject.executors.push_back(executor.name);
  for (const ComponentConfig& component : config.components) {
    for (const PortBinding& output : component.outputs) {
      if (output.spec.measured) subject.measured.push_back(ros_topic_name(output.topic));
    }
  }
  if (subject.measured.empty())
    throw InvalidChoice("nothing is measured there, so none can read it");
  return subject;
}

/// Processor time that the threads of a process have had, by name [s].
std::map<std::string, double> processor_times(pid_t process) {
  std::map<std::string, double> times;
  for (const auto& thread : fs::directory_iterator{fmt::format("/proc/{}/task", process)}) {
    std::string name = content_of(thread.path() / "comm");
    name = name.substr(0, name.find('\n'));
    times[name] += 1e-9 * std::strtod(content_of(thread.path() / "schedstat").c_str(), nullptr);
  }
  return times;
}

/// Threads whose cycles the run has told at its end (--timing --json).
WatchedRun run_of(std::map<std::string, double> times, const Subject& subject,
                  const Program& program) {
  const auto told = nlohmann::json::parse(program.out(), nullptr, false);
  if (told.is_discarded() || !told.contains("timing")) {
    throw std::runtime_error{"the run says: " + program.err()};
  }
  WatchedRun run;
  for (const std::string& executor : subject.executors) {
    const auto time = times.extract(executor.substr(0, kThreadName));
    if (time.empty()) continue;
    const auto& cycle = told["timing"]["executors"][executor]["cycle"];
    run.own[executor] = {.processor_s = time.mapped(), .cycles = cycle.value("count", 0U)};
  }
  for (const auto& [name, time] : times) run.others_s += time;
  return run;
}

/// Waits until the run has begun: its first thread has stepped.
void await_start(Program& run, const Subject& subject) {
  constexpr int kTimeout_s = 60;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds{kTimeout_s};
  const auto has_stepped = [&] {
    const auto times = processor_times(run.pid());
    return std::ranges::any_of(subject.executors, [&](const std::string& executor) {
      const auto time = times.find(executor.substr(0, kThreadName));
      return time != times.end() && time->second > 0;
    });
  };
  while (!has_stepped()) {
    if (run.has_ended()) {
      throw std::runtime_error{"the deployment ended before it began: " + run.err()};
    }
    if (std::chrono::steady_clock::now() > end) {
      throw std::runtime_error{
          fmt::format("the deployment has not begun within {} s: {}", kTimeout_s, run.err())};
    }
    bench::pause_s(0.005);
  }
}

std::vector<std::string> run_words(const WatchedBenchOptions& options) {
  std::vector<std::string> words{"run",    "--keep-running", "--timing",
                                 "--json", "--domain",       std::to_string(options.domain)};
  for (const auto& assignment : options.source.assignments) {
    words.insert(words.end(), {"--set", assignment});
  }
  for (const auto& file : options.source.files) words.push_back(file.string());
  return words;
}

/// Messages that came faster than the run wrote them. Throws std::runtime_error when it has not
/// told of its recording.
std::uint64_t lost_by_run(const Program& run) {
  const std::string told = run.err();
  if (told.find("recorded: ") == std::string::npos) {
    throw std::runtime_error{"the run has recorded nothing: " + told};
  }
  const std::size_t end = told.find(" came faster than");
  if (end == std::string::npos) return 0;
  return std::stoull(told.substr(told.rfind(' ', end - 1)));
}

std::uint64_t lost_by_recorder(const Program& recorder) {
  const auto told = nlohmann::json::parse(recorder.out(), nullptr, false);
  if (told.is_discarded()) throw std::runtime_error{"the recorder says: " + recorder.err()};
  return told.at("lost").get<std::uint64_t>() + told.at("dropped").get<std::uint64_t>();
}

WatchedRun measure(const WatchedBenchOptions& options, const Subject& subject, Watching watching) {
  const TemporaryFolder folder;
  const std::string domain = std::to_string(options.domain);
  auto words = run_words(options);
  if (watching == Watching::recorded) {
    const std::string file = folder.path() / "run.mcap";
    words.insert(words.end(), {"--set", "record.file=" + file});
  }
  std::unique_ptr<Program> recorder;
  std::vector<std::unique_ptr<Program>> readers;
  if (watching == Watching::read) {
    const std::string file = folder.path() / "topics.mcap";
    recorder = std::make_unique<Program>(
        std::vector<std::string>{"record", "-o", file, "--json", "--domain", domain},
        folder.path() / "recorder");
    for (int i = 0; i < options.readers; ++i) {
      const auto& topic = subject.measured[static_cast<std::size_t>(i) % subject.measured.size()];
      readers.push_back(std::make_unique<Program>(
          std::vector<std::string>{"topic", "hz", topic, "--domain", domain}));
    }
    bench::pause_s(1);  // they are there before what they watch
  }
  Program run{words, folder.path() / "run"};
  await_start(run, subject);
  bench::pause_s(options.seconds);
  auto times = processor_times(run.pid());
  run.interrupt();
  WatchedRun measured = run_of(std::move(times), subject, run);
  if (watching == Watching::recorded) measured.lost = lost_by_run(run);
  if (recorder) {
    recorder->interrupt();
    measured.lost = lost_by_recorder(*recorder);
  }
  return measured;
}

}  // namespace

int bench_watched(const WatchedBenchOptions& options) {
  leave_in_order();
  const Subject subject = subject_of(options.source);
  WatchedReport report{.options = options, .machine = bench::this_machine(), .rounds = {}};
  std::vector<Watching> order{bench::kWatching.begin(), bench::kWatching.end()};
  std::mt19937 random{1};
  Progress progress{"runs"};
  const auto runs = static_cast<std::size_t>(options.rounds) * order.size();
  std::size_t done = 0;
  for (int i = 0; i < options.rounds; ++i) {
    WatchedRound round;
    std::ranges::shuffle(order, random);
    for (const Watching watching : order) {
      round[static_cast<std::size_t>(watching)] = measure(options, subject, watching);
      progress.of(++done, runs);
    }
    report.rounds.push_back(round);
  }
  print_out("{}", options.json ? bench::to_json(report) + "\n" : bench::table(report));
  return bench::is_met(report) ? kOk : kFailed;
}

}  // namespace armature
