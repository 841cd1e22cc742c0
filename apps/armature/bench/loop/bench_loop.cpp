// SPDX-License-Identifier: Apache-2.0
#include "bench/loop/bench_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "armature/values/temporary_folder.hpp"
#include "bench/loop/loop_report.hpp"
#include "bench/loop/measured_loop.hpp"
#include "bench/loop/page.hpp"
#include "bench/pause.hpp"
#include "bench/processors.hpp"
#include "bench/program.hpp"
#include "bench/statistics.hpp"
#include "exit_code.hpp"
#include "progress.hpp"
#include "standard_output.hpp"
#include "watch/outsider.hpp"

namespace armature {
namespace {

using bench::LoopReport;
using bench::LoopSide;
using bench::MeasuredLoop;

/// The port that `armature monitor` has told. Throws std::runtime_error.
int port_of(const bench::Program& monitor) {
  constexpr int kTimeout_ms = 20'000;
  constexpr std::string_view kAddress = "ws://127.0.0.1:";
  for (int waited_ms = 0; waited_ms < kTimeout_ms; waited_ms += 10) {
    const std::string told = monitor.out();
    const std::size_t at = told.find(kAddress);
    if (at != std::string::npos) return std::stoi(told.substr(at + kAddress.size()));
    bench::pause_s(0.01);
  }
  throw std::runtime_error{"the monitor has not told its address within 20 s: " + monitor.err()};
}

/// Other processes that watch the bench's loop: some that read its joint state, and with
/// `everything` a recorder of all topics and a page of a monitor.
class Watchers {
 public:
  Watchers(int readers, bool everything, int domain) : readers_{readers} {
    const std::string number = std::to_string(domain);
    for (int i = 0; i < readers; ++i) {
      start({"topic", "hz", "/bench_loop/joint_state", "--domain", number});
    }
    if (!everything) return;
    start({"record", "-o", folder_.path() / "topics.mcap", "--domain", number});
    const auto& monitor =
        start({"monitor", "--port", "0", "--domain", number}, folder_.path() / "monitor");
    start({"bench", "loop", "--page", std::to_string(port_of(monitor))});
    readers_ += 2;  // the monitor reads for its page
  }
  /// The number of processes that read the joint state once all are there.
  int readers() const { return readers_; }
  /// Where the loop may record itself.
  std::string recording() const { return folder_.path() / "run.mcap"; }

 private:
  const bench::Program& start(std::vector<std::string> words,
                              const std::filesystem::path& output = {}) {
    programs_.push_back(std::make_unique<bench::Program>(std::move(words), output));
    return *programs_.back();
  }

  int readers_;
  TemporaryFolder folder_;
  std::vector<std::unique_ptr<bench::Program>> programs_;
};

/// What a contestant had counted when a round began.
struct Begin {
  TimingHistogram::Counts lateness;
  bench::ThreadCounts thread;
};

Begin begin_of(MeasuredLoop& contestant) {
  Begin begin;
  if (!contestant.requests().ask(begin.thread)) throw std::runtime_error{"a loop stands still"};
  begin.lateness = contestant.lateness().counts();
  return begin;
}

LoopSide side_since(MeasuredLoop& contestant, const Begin& begin) {
  const TimingFigures lateness = contestant.lateness().counts().figures_since(begin.lateness);
  const Begin end = begin_of(contestant);
  return {.lateness = lateness,
          .page_faults = end.thread.page_faults - begin.thread.page_faults,
          .allocations = end.thread.allocations - begin.thread.allocations};
}

/// Until it has made the steps that fill queues and touch memory for the first time. How long it
/// takes to begin at all is not measured.
void settle(MeasuredLoop& contestant) {
  constexpr std::uint64_t kSteps = 300;
  constexpr auto kTimeout = std::chrono::seconds{60};
  const auto end = std::chrono::steady_clock::now() + kTimeout;
  while (contestant.lateness().counts().figures().count < kSteps) {
    if (std::chrono::steady_clock::now() > end) throw std::runtime_error{"a loop stands still"};
    bench::pause_s(0.01);
  }
}

/// Both at the same time, half of it on each other's processor.
bench::LoopRound round_of(MeasuredLoop& a, MeasuredLoop& b, std::pair<int, int> cpus,
                          double seconds) {
  a.requests().move(cpus.first);
  b.requests().move(cpus.second);
  settle(a);
  settle(b);
  const Begin begin_a = begin_of(a), begin_b = begin_of(b);
  bench::pause_s(seconds / 2);
  a.requests().move(cpus.second);
  b.requests().move(cpus.first);
  bench::pause_s(seconds / 2);
  return {.a = side_since(a, begin_a), .b = side_since(b, begin_b)};
}

void await_readers(const bench::OurLoop& loop, int count) {
  constexpr int kTimeout_ms = 20000;
  for (int i = 0; loop.readers() < count; ++i) {
    if (i == kTimeout_ms) {
      throw std::runtime_error{
          fmt::format("only {} of {} readers have come", loop.readers(), count)};
    }
    bench::pause_s(0.001);
  }
}

}  // namespace

std::string wrong_round(const LoopBenchOptions& options) {
  constexpr double kSteps = 1000;
  const double steps = options.seconds / options.period_s;
  if (steps > kSteps - 0.5) return "";
  return fmt::format(
      "a round of {:g} s has {:.0f} steps of {:g} s, and p99.9 needs {:g}: at least {:g} s",
      options.seconds, steps, options.period_s, kSteps, kSteps * options.period_s);
}

int bench_loop(const LoopBenchOptions& options) {
  if (options.page) return bench::read_as_a_page(*options.page);
  leave_in_order();
  const auto cpus = bench::two_cpus();
  const bench::LoopSettings settings{
      .period_s = options.period_s, .priority = options.priority, .domain = options.domain};
  LoopReport report{.options = options, .machine = bench::this_machine(), .notes = {}, .noise = {}};
  report.watched.emplace_back();
  if (options.readers > 0) report.watched.push_back({.readers = options.readers});
  if (options.everything) {
    report.watched.push_back({.readers = std::max(options.readers, 4), .everything = true});
  }
  Progress progress{"rounds"};
  const double work = options.rounds * static_cast<double>(1 + report.watched.size());
  double done = 0;
  for (int round = 0; round < options.rounds; ++round) {
    {
      bench::Twin a{settings}, b{settings};
      report.noise.push_back(round_of(a, b, cpus, options.seconds));
      progress.part(++done / work);
    }
    for (auto& watched : report.watched) {
      const Watchers watchers{watched.readers, watched.everything, options.domain};
      bench::LoopSettings own = settings;
      if (watched.everything) own.recording = watchers.recording();
      bench::OurLoop ours{own, [&](const std::string& note) {
                            if (!note.starts_with("recorded: ")) report.notes.insert(note);
                          }};
      bench::Twin twin{settings};
      await_readers(ours, watchers.readers());
      watched.rounds.push_back(round_of(ours, twin, cpus, options.seconds));
      progress.part(++done / work);
    }
  }
  print_out("{}", options.json ? bench::to_json(report) + "\n" : bench::table(report));
  return bench::is_met(report) ? kOk : kFailed;
}

}  // namespace armature
