// SPDX-License-Identifier: Apache-2.0
#include "drill/drill.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <mutex>
#include <optional>
#include <random>
#include <stop_token>
#include <thread>

#include "armature/config/problems.hpp"
#include "armature/runtime/processes/instance_lock.hpp"
#include "armature/runtime/processes/running_processes.hpp"
#include "drill/drill_report.hpp"
#include "drill/trial.hpp"
#include "exit_code.hpp"
#include "run/end_signals.hpp"
#include "standard_output.hpp"

namespace armature {
namespace drill {
namespace {

/// One fault to be fired.
struct Planned {
  Fault fault;
  Form form;
  double moment_s;
};

/// A DDS domain that no other drill and no deployment of this machine uses.
struct OwnDomain {
  int number;
  InstanceLock lock;
};

Expected<InstanceLock> lock_of(int domain) {
  return InstanceLock::take(fmt::format("drill domain {}", domain));
}

/// A drill stops every arm of its domain, and writes there as a stranger.
void refuse_if_used(int domain) {
  const auto running = running_processes(domain);
  if (running.empty()) return;
  throw std::runtime_error{fmt::format(
      "{} runs in domain {}, and a drill would stop its arms; name another domain with --domain, "
      "or none",
      running.front().text(), domain)};
}

OwnDomain own_domain(const std::optional<int>& wanted) {
  if (wanted) {
    refuse_if_used(*wanted);
    auto lock = lock_of(*wanted);
    if (lock) return {.number = *wanted, .lock = std::move(*lock)};
    throw std::runtime_error{
        fmt::format("another drill ({}) has domain {}; name another domain with --domain, or none",
                    lock.error().text, *wanted)};
  }
  constexpr int kDomains = 100;  // beyond them UDP ports lie where the kernel hands out its own
  std::random_device random;
  const int first = std::uniform_int_distribution{0, kDomains - 1}(random);
  for (int i = 0; i < kDomains; ++i) {
    const int domain = 1 + (first + i) % kDomains;
    auto lock = lock_of(domain);
    if (lock && running_processes(domain).empty()) {
      return {.number = domain, .lock = std::move(*lock)};
    }
  }
  throw std::runtime_error("drills and deployments use every domain; name one with --domain");
}

void check_names(const std::vector<std::string>& wanted) {
  const std::vector<std::string> known = fault_names();
  for (const std::string& name : wanted) {
    if (std::ranges::find(known, name) != known.end()) continue;
    throw InvalidChoice(fmt::format("no fault '{}'{}", name, config::did_you_mean(name, known)));
  }
}

std::vector<Planned> plan(const DrilledDeployment& deployment, const DrillOptions& options,
                          std::uint64_t seed) {
  std::mt19937_64 random{seed};
  std::uniform_real_distribution<double> moment{0, options.within_s};
  std::vector<Planned> planned;
  for (const Form form : {Form::single, Form::split}) {
    for (const Fault& fault : faults_of(deployment, form)) {
      const bool wanted = options.faults.empty() ||
                          std::ranges::find(options.faults, fault.name) != options.faults.end();
      for (int i = 0; wanted && i < options.moments; ++i) {
        planned.push_back({fault, form, moment(random)});
      }
    }
  }
  if (options.brief) std::ranges::shuffle(planned, random);
  return planned;
}

/// Names what was asked for and does not apply. A drill that fires nothing proves nothing.
void tell_inapplicable(const std::string& deployment, const std::vector<std::string>& wanted,
                       const std::vector<Planned>& planned) {
  std::vector<std::string> inapplicable;
  for (const std::string& name : wanted) {
    const bool applies =
        std::ranges::any_of(planned, [&](const Planned& one) { return one.fault.name == name; });
    if (!applies) inapplicable.push_back(name);
  }
  if (inapplicable.empty()) return;
  const std::string text = fmt::format("deployment '{}' cannot meet these faults: {}", deployment,
                                       fmt::join(inapplicable, ", "));
  if (planned.empty()) throw InvalidChoice(text);
  fmt::print(stderr, "armature: {}\n", text);
}

/// Fires what is planned, some at a time, and shows each result as it comes. A signal interrupts
/// the runs; the drill is over when they have ended.
class Drill {
 public:
  Drill(const DrillOptions& options, const DrilledDeployment& deployment,
        std::vector<Planned> planned)
      : options_{&options}, deployment_{&deployment}, planned_{std::move(planned)} {}

  std::vector<TrialResult> run() {
    const int jobs = options_->domain ? 1 : options_->jobs;
    {
      std::atomic<int> working{jobs};
      std::vector<std::jthread> workers;
      for (int i = 0; i < jobs; ++i) {
        workers.emplace_back([this, &working] {
          work();
          --working;
        });
      }
      for (; working > 0; std::this_thread::sleep_for(kLook)) look_for_signal();
    }
    if (error_) std::rethrow_exception(error_);
    return std::move(results_);
  }
  /// The signal that interrupted the drill, in words; nothing: none did.
  const std::optional<std::string>& stopped() const { return stopped_; }

 private:
  using Clock = std::chrono::steady_clock;

  void look_for_signal() {
    if (stopped_) return;
    stopped_ = end_signals::cause();
    if (!stopped_) return;
    fmt::print(stderr, "armature: {}; runs that were started come to rest first\n", *stopped_);
    stop_.request_stop();
  }

  void work() {
    try {
      PluginRegistry plugins;
      const OwnDomain domain = own_domain(options_->domain);
      while (const Planned* planned = next()) {
        const auto start = Clock::now();
        const TrialResult result = try_fault({.source = options_->source,
                                              .deployment = *deployment_,
                                              .plugins = plugins,
                                              .domain = domain.number,
                                              .stop = stop_.get_token()},
                                             planned->fault, planned->form, planned->moment_s);
        if (stop_.stop_requested()) return;
        keep(result, Clock::now() - start);
      }
    } catch (...) {
      const std::scoped_lock lock{mutex_};
      error_ = std::current_exception();
    }
  }

  /// In the short form: until there is no time for another one like the longest so far.
  const Planned* next() {
    const std::scoped_lock lock{mutex_};
    const bool too_late = options_->brief && Clock::now() - start_ + longest_ > kBrief;
    if (too_late || error_ || stop_.stop_requested() || next_ == planned_.size()) return nullptr;
    return &planned_[next_++];
  }

  void keep(const TrialResult& result, Clock::duration took) {
    const std::scoped_lock lock{mutex_};
    longest_ = std::max(longest_, took);
    results_.push_back(result);
    if (options_->json) return;
    print_out("{}\n", table_row(result));
    std::fflush(standard_output());
  }

  static constexpr std::chrono::seconds kBrief{30};
  static constexpr std::chrono::milliseconds kLook{10};
  const DrillOptions* options_;
  const DrilledDeployment* deployment_;
  const std::vector<Planned> planned_;
  const Clock::time_point start_ = Clock::now();
  std::mutex mutex_;
  std::size_t next_ = 0;
  Clock::duration longest_{0};
  std::vector<TrialResult> results_;
  std::exception_ptr error_;
  std::stop_source stop_;
  std::optional<std::string> stopped_;
};

}  // namespace
}  // namespace drill

int run_drill(const DrillOptions& options) {
  drill::check_names(options.faults);
  const PluginRegistry plugins;
  const drill::DrilledDeployment deployment = drill::read_drilled(options.source, plugins);
  const std::uint64_t seed = options.seed.value_or(std::random_device{}());
  auto planned = drill::plan(deployment, options, seed);
  drill::tell_inapplicable(deployment.name, options.faults, planned);
  if (!options.json) print_out("{}: --seed {}\n{}\n", deployment.name, seed, drill::table_head());
  std::fflush(standard_output());
  drill::Drill drill{options, deployment, std::move(planned)};
  end_signals::say({.json = options.json});
  end_signals::stop_in_order();
  const auto results = drill.run();
  print_out("{}\n", options.json ? to_json(deployment.name, seed, results, drill.stopped())
                                 : counts(results));
  if (drill.stopped()) return kFailed;
  return drill::has_passed(results) ? kOk : kFailed;
}

}  // namespace armature
