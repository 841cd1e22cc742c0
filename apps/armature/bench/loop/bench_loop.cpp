// SPDX-License-Identifier: Apache-2.0
#include "bench/loop/bench_loop.hpp"

#include <fmt/format.h>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "bench/loop/loop_report.hpp"
#include "bench/loop/measured_loop.hpp"
#include "bench/processors.hpp"
#include "bench/program.hpp"
#include "bench/statistics.hpp"
#include "exit_code.hpp"
#include "progress.hpp"

namespace armature {
namespace {

using bench::LoopReport;
using bench::LoopSide;
using bench::MeasuredLoop;

/// Other processes that read the bench's joint state: `armature topic hz`, silent.
std::vector<std::unique_ptr<bench::Program>> start_readers(int count, int domain) {
  std::vector<std::unique_ptr<bench::Program>> readers;
  while (std::ssize(readers) < count) {
    readers.push_back(std::make_unique<bench::Program>(std::vector<std::string>{
        "topic", "hz", "/bench_loop/joint_state", "--domain", std::to_string(domain)}));
  }
  return readers;
}

void wait_for(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>{seconds});
}

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
    wait_for(0.01);
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
  wait_for(seconds / 2);
  a.requests().move(cpus.second);
  b.requests().move(cpus.first);
  wait_for(seconds / 2);
  return {.a = side_since(a, begin_a), .b = side_since(b, begin_b)};
}

void await_readers(const bench::OurLoop& loop, int count) {
  constexpr int kTimeout_ms = 20000;
  for (int i = 0; loop.readers() < count; ++i) {
    if (i == kTimeout_ms) {
      throw std::runtime_error{
          fmt::format("only {} of {} readers have come", loop.readers(), count)};
    }
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
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
  const auto cpus = bench::two_cpus();
  const bench::LoopSettings settings{
      .period_s = options.period_s, .priority = options.priority, .domain = options.domain};
  LoopReport report{.options = options,
                    .machine = bench::this_machine(),
                    .notes = {},
                    .noise = {},
                    .watched = {}};
  std::vector<int> reader_counts{0};
  if (options.readers > 0) reader_counts.push_back(options.readers);
  Progress progress{"rounds"};
  const double work = options.rounds * static_cast<double>(1 + reader_counts.size());
  double done = 0;
  for (const int count : reader_counts) report.watched.push_back({.readers = count, .rounds = {}});
  for (int round = 0; round < options.rounds; ++round) {
    {
      bench::Twin a{settings}, b{settings};
      report.noise.push_back(round_of(a, b, cpus, options.seconds));
      progress.part(++done / work);
    }
    for (auto& watched : report.watched) {
      const auto readers = start_readers(watched.readers, options.domain);
      bench::OurLoop ours{settings, [&](const std::string& note) { report.notes.insert(note); }};
      bench::Twin twin{settings};
      await_readers(ours, watched.readers);
      watched.rounds.push_back(round_of(ours, twin, cpus, options.seconds));
      progress.part(++done / work);
    }
  }
  fmt::print("{}", options.json ? bench::to_json(report) + "\n" : bench::table(report));
  return bench::is_met(report) ? kOk : kFailed;
}

}  // namespace armature
