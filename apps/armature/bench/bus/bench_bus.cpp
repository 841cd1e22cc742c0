// SPDX-License-Identifier: Apache-2.0
#include "bench/bus/bench_bus.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <functional>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "armature/bus/fast_dds/plain_exchange.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "armature/values/spawn_plan.hpp"
#include "armature/values/wake_up.hpp"
#include "bench/bus/bus_report.hpp"
#include "bench/bus/topic_exchange.hpp"
#include "bench/processors.hpp"
#include "bench/statistics.hpp"
#include "exit_code.hpp"
#include "progress.hpp"

namespace armature {
namespace {

using bench::BusReport;
using bench::BusRound;
using bench::TopicExchange;
using bench::TripTimes;
using Clock = std::chrono::steady_clock;

/// The process that answers: this program again. It ends with this object, and when its input ends.
class AnsweringProcess {
 public:
  explicit AnsweringProcess(int domain) {
    if (pipe(life_) != 0) fail(errno);
    SpawnPlan plan;
    plan.hand_over(life_[0], STDIN_FILENO).close_from(STDERR_FILENO + 1);
    const int error = plan.start(
        "/proc/self/exe",
        {"armature", "bench", "bus", "--answers", "--domain", std::to_string(domain)}, process_);
    close(life_[0]);
    if (error != 0) fail(error);
  }
  ~AnsweringProcess() {
    close(life_[1]);
    waitpid(process_, nullptr, 0);
  }
  AnsweringProcess(const AnsweringProcess&) = delete;
  AnsweringProcess& operator=(const AnsweringProcess&) = delete;

 private:
  [[noreturn]] static void fail(int error) {
    throw std::system_error(error, std::generic_category(),
                            "cannot start the process that answers");
  }
  int life_[2] = {-1, -1};
  pid_t process_ = 0;
};

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

  std::vector<double> round_trips(int count) {
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

TripTimes figures(const std::vector<double>& times, int expected, const char* what) {
  if (std::cmp_less(times.size(), expected)) {
    throw std::runtime_error{fmt::format("{}: an answer did not come within a second", what)};
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
    std::this_thread::sleep_for(std::chrono::milliseconds{5});
  }
}

int answer(const BusBenchOptions& options, int cpu) {
  bench::move_to_cpu(cpu);
  PluginRegistry plugins;
  const auto plain = plain_exchange(plugins, options);
  const TopicExchange topics{{.part = TopicExchange::Part::answers, .domain = options.domain}};
  pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
  while (poll(&input, 1, -1) < 0) {
  }
  return kOk;
}

}  // namespace

int bench_bus(const BusBenchOptions& options) {
  // CDR of a picture without any pixel has 40 B.
  constexpr std::size_t kSmall = 24;
  const auto [here, there] = bench::two_cpus();
  if (options.answers) return answer(options, there);
  const AnsweringProcess process{options.domain};
  bench::move_to_cpu(here);
  PluginRegistry plugins;
  const auto plain = plain_exchange(plugins, options);
  TopicExchange across{{.part = TopicExchange::Part::asks, .domain = options.domain}};
  TopicExchange inside{{.domain = options.domain, .ask_cpu = here, .answer_cpu = there}};
  HandOvers across_processors{here, there}, on_one{here, here};
  await([&] { return plain->met(); }, "Fast DDS");
  // The other process may begin later than this one, and hears nothing before.
  await([&] { return inside.round_trips(QosProfile::state, kSmall, 1).size() == 1; },
        "a component");
  for (const QosProfile qos : {QosProfile::state, QosProfile::sensor}) {
    await([&] { return across.round_trips(qos, kSmall, 1).size() == 1; }, "the deployment");
  }

  constexpr int kSmallTrips = 200, kPictureTrips = 40;
  BusRound round;
  std::vector<std::function<void()>> parts{
      [&] {
        round.hand_over_here =
            half(figures(on_one.round_trips(kSmallTrips), kSmallTrips, "a thread"));
      },
      [&] {
        round.hand_over_across =
            half(figures(across_processors.round_trips(kSmallTrips), kSmallTrips, "a thread"));
      },
      [&] {
        round.hop = half(figures(inside.round_trips(QosProfile::state, kSmall, kSmallTrips),
                                 kSmallTrips, "a component"));
      },
      [&] {
        round.plain_small = figures(plain->round_trips(QosProfile::state, kSmall, kSmallTrips),
                                    kSmallTrips, "Fast DDS");
      },
      [&] {
        round.small = figures(across.round_trips(QosProfile::state, kSmall, kSmallTrips),
                              kSmallTrips, "a small topic");
      },
      [&] {
        round.plain_picture =
            figures(plain->round_trips(QosProfile::sensor, options.picture_bytes, kPictureTrips),
                    kPictureTrips, "Fast DDS");
      },
      [&] {
        round.picture =
            figures(across.round_trips(QosProfile::sensor, options.picture_bytes, kPictureTrips),
                    kPictureTrips, "a topic of pictures");
      }};
  BusReport report{.options = options, .machine = bench::this_machine(), .rounds = {}};
  Progress progress{"rounds"};
  std::mt19937 order{1};
  for (int i = -1; i < options.rounds; ++i) {  // the first one touches memory for the first time
    std::ranges::shuffle(parts, order);
    for (const auto& part : parts) part();
    if (i >= 0) report.rounds.push_back(round);
    progress.part((i + 1.0) / options.rounds);
  }
  fmt::print("{}", options.json ? bench::to_json(report) + "\n" : bench::table(report));
  return bench::is_met(report) ? kOk : kFailed;
}

}  // namespace armature
