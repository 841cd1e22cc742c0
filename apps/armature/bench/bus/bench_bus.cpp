// SPDX-License-Identifier: Apache-2.0
#include "bench/bus/bench_bus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "armature/bus/fast_dds/plain_exchange.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "armature/values/wake_up.hpp"
#include "bench/bus/bus_report.hpp"
#include "bench/bus/topic_exchange.hpp"
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

using bench::BusReport;
using bench::BusRound;
using bench::TopicExchange;
using bench::TripTimes;
using Clock = std::chrono::steady_clock;

PluginPtr<PlainExchange> plain_exchange(PluginRegistry& plugins, const BusBenchOptions& options) {
  auto made = plugins.make<PlainExchange>(
      "exchange/fast_dds",
      PlainExchangeOptions{.domain = options.domain, .answers = options.answers});
  if (!made) throw std::runtime_error{made.error().text};
  return std::move(*made);
}

/// Two threads on these processors that wake each other, as the bench finds them.
class HandOvers {
 public:
  HandOvers(int cpu, int other_cpu)
      : cpu_{cpu}, thread_{[this, other_cpu] {
          bench::move_to_cpu(other_cpu);
          while (true) {
            there_.wait();
            if (end_) return;
            back_.notify();
          }
        }} {}
  ~HandOvers() {
    end_ = true;
    there_.notify();
    thread_.join();
  }
  HandOvers(const HandOvers&) = delete;
  HandOvers& operator=(const HandOvers&) = delete;

  /// The signature is that of an exchange; what is sent does not matter to threads.
  std::vector<double> round_trips(QosProfile, std::size_t, int count) {
    std::vector<double> times;
    std::thread{[&] {
      bench::move_to_cpu(cpu_);
      while (count-- > 0) {
        const auto begin = Clock::now();
        there_.notify();
        back_.wait();
        times.push_back(std::chrono::duration<double>(Clock::now() - begin).count());
      }
    }}.join();
    return times;
  }

 private:
  int cpu_;
  WakeUp there_, back_;
  std::atomic<bool> end_{false};
  std::thread thread_;
};

TripTimes figures(const std::vector<double>& times, int expected) {
  if (std::cmp_less(times.size(), expected)) {
    throw std::runtime_error{
        "an answer did not come within a second; does another bench run in this domain "
        "(--domain)?"};
  }
  return {.p50_s = bench::quantile(times, 0.5), .p99_s = bench::quantile(times, 0.99)};
}

TripTimes half(const TripTimes& times) {
  return {.p50_s = times.p50_s / 2, .p99_s = times.p99_s / 2};
}

void await(const std::function<bool()>& met, const char* what) {
  constexpr std::chrono::seconds kTimeout{20};
  const auto end = Clock::now() + kTimeout;
  while (!met()) {
    if (Clock::now() > end) {
      throw std::runtime_error{fmt::format("{} has not met the process that answers", what)};
    }
    bench::pause_s(0.005);
  }
}

int answer(const BusBenchOptions& options, int cpu) {
  leave_in_order();
  bench::move_to_cpu(cpu);
  PluginRegistry plugins;
  const auto plain = plain_exchange(plugins, options);
  const TopicExchange topics{{.part = TopicExchange::Part::answers, .domain = options.domain}};
  while (wait_for(seconds(1))) {  // until the bench ends it
  }
  return kOk;
}

/// All that is measured. A process stays on one processor each: where the system puts threads would
/// decide more than who carries the message.
class Contestants {
 public:
  Contestants(const BusBenchOptions& options, int here, int there)
      : picture_bytes_{options.picture_bytes},
        across_processors_{here, there},
        on_one_{here, here},
        plain_{plain_exchange(plugins_, options)},
        across_{{.part = TopicExchange::Part::asks, .domain = options.domain}},
        inside_{{.domain = options.domain, .ask_cpu = here, .answer_cpu = there}} {
    await([&] { return plain_->met(); }, "Fast DDS");
    // The other process may begin later than this one, and hears nothing before.
    for (const QosProfile qos : {QosProfile::state, QosProfile::sensor}) {
      await([&] { return across_.round_trips(qos, kSmall, 1).size() == 1; }, "a topic");
    }
    await([&] { return inside_.round_trips(QosProfile::state, kSmall, 1).size() == 1; }, "a hop");
  }

  /// Measures everything once, in an order by chance.
  BusRound round(std::mt19937& random) {
    BusRound round;
    std::vector<std::function<void()>> parts{
        [&] { round.hand_over_here = half(small_trips(on_one_)); },
        [&] { round.hand_over_across = half(small_trips(across_processors_)); },
        [&] { round.hop = half(small_trips(inside_)); },
        [&] { round.plain_small = small_trips(*plain_); },
        [&] { round.small = small_trips(across_); },
        [&] { round.plain_picture = picture_trips(*plain_); },
        [&] { round.picture = picture_trips(across_); }};
    std::ranges::shuffle(parts, random);
    for (const auto& part : parts) part();
    return round;
  }

 private:
  static constexpr std::size_t kSmall = 24;  // with the 40 B of an empty picture

  template <class Exchange>
  TripTimes small_trips(Exchange& exchange) {
    constexpr int kTrips = 200;
    return figures(exchange.round_trips(QosProfile::state, kSmall, kTrips), kTrips);
  }
  template <class Exchange>
  TripTimes picture_trips(Exchange& exchange) {
    constexpr int kTrips = 40;
    return figures(exchange.round_trips(QosProfile::sensor, picture_bytes_, kTrips), kTrips);
  }

  std::size_t picture_bytes_;
  HandOvers across_processors_, on_one_;
  PluginRegistry plugins_;
  PluginPtr<PlainExchange> plain_;
  TopicExchange across_, inside_;
};

}  // namespace

int bench_bus(const BusBenchOptions& options) {
  const auto [here, there] = bench::two_cpus();
  if (options.answers) return answer(options, there);
  leave_in_order();
  BusReport report{.options = options, .machine = bench::this_machine(), .rounds = {}};
  const bench::Program answerer{
      {"bench", "bus", "--answers", "--domain", std::to_string(options.domain)}};
  bench::move_to_cpu(here);
  Contestants contestants{options, here, there};
  std::mt19937 order{1};
  contestants.round(order);  // touches memory for the first time
  Progress progress{"rounds"};
  for (int i = 0; i < options.rounds; ++i) {
    bench::pause_s(0);
    report.rounds.push_back(contestants.round(order));
    progress.part((i + 1.0) / options.rounds);
  }
  print_out("{}", options.json ? bench::to_json(report) + "\n" : bench::table(report));
  return bench::is_met(report) ? kOk : kFailed;
}

}  // namespace armature
