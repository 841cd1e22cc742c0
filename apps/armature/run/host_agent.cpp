// SPDX-License-Identifier: Apache-2.0
#include "run/host_agent.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <deque>
#include <random>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "armature/bus/transport.hpp"
#include "armature/runtime/hosts/host_link.hpp"
#include "armature/runtime/processes/instance_lock.hpp"
#include "armature/runtime/processes/started_process.hpp"
#include "armature/values/sanitizer.hpp"
#include "exit_code.hpp"
#include "run/console.hpp"
#include "run/end_signals.hpp"
#include "run/other_processes.hpp"

namespace armature {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLook{5};
constexpr std::size_t kFirstQuestions = 12;
constexpr std::chrono::seconds kClockAnswersWithin{5};
constexpr std::chrono::milliseconds kAskFirst{20}, kAskEvery{200}, kFollowEvery{1000};
/// The main process' clock is known to half of the round trip of a question.
constexpr Duration kMaxRoundTrip = seconds(0.02);
/// Two clocks that go on drift apart by microseconds in a second, which the processes follow; where
/// they come to be so far behind, one of the clocks is broken.
constexpr Duration kMaxClockLag = seconds(0.01);

std::string random_id() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}", random(), random());
}

class HostAgent {
 public:
  HostAgent(const RunOptions& options, const DeploymentConfig& deployment, int domain,
            PluginRegistry& plugins)
      : options_{options},
        deployment_{deployment},
        domain_{domain},
        transport_{join(plugins)},
        link_{*transport_,
              {.deployment = deployment.name,
               .host = options.host,
               .of_main = false,
               .id = random_id()},
              clock_} {
    console_.start(clock_, clock_.now());
  }

  int run() {
    if (!meet() || !set_clock()) return kFailed;
    start_processes();
    while (!over()) {
      link_.update();
      pass_on();
      follow_clock();
      std::this_thread::sleep_for(kLook);
    }
    take_leave();
    return well_ ? kOk : kFailed;
  }

 private:
  struct Process {
    std::string name;
    StartedProcess started;
    bool ended = false;
  };

  PluginPtr<Transport> join(PluginRegistry& plugins) {
    const TransportOptions options{.network = deployment_.dds.network(domain_),
                                   .deployment = deployment_.name,
                                   .fingerprint = deployment_.fingerprint,
                                   .process = "host " + options_.host,
                                   .on_event =
                                       [this](const TransportEvent& event) {
                                         if (event.kind == TransportEvent::Kind::note)
                                           console_.line("host", event.text);
                                       },
                                   .now = [this] { return clock_.now(); }};
    auto transport = plugins.make<Transport>("transport/fast_dds", options);
    if (!transport) throw PluginError("cannot join DDS: " + transport.error().text);
    return std::move(*transport);
  }

  void say(std::string_view line) { link_.send(HostLink::kAgent, line); }
  std::optional<std::string> told() { return link_.receive(HostLink::kAgent); }

  /// Until the main process has said which run this is; false: the operator left.
  bool meet() {
    console_.line("host", fmt::format("'{}' waits for the main process of '{}' in domain {}",
                                      options_.host, deployment_.name, domain_));
    say("here " + deployment_.fingerprint);
    while (!end_signals::cause()) {
      link_.update();
      if (const auto line = told()) {
        std::istringstream words{*line};
        std::string word;
        words >> word >> origin_.run >> origin_.start.ns >> options_.timing >>
            options_.keep_running;
        if (word == "run" && words) return true;
        throw std::runtime_error{line->substr(line->find(' ') + 1)};
      }
      std::this_thread::sleep_for(kLook);
    }
    return false;
  }

  /// Measures the main process' clock; false: the operator left.
  bool set_clock() {
    auto next = SteadyClock::now();
    const auto deadline = next + kClockAnswersWithin;
    // Where packets are lost most answers are late; one that is not is enough.
    const auto is_known = [&] {
      return link_.clock_answers() >= kFirstQuestions &&
             link_.clock_ahead()->round_trip <= kMaxRoundTrip;
    };
    while (!is_known() && !end_signals::cause()) {
      if (SteadyClock::now() > deadline) {
        if (link_.clock_ahead()) break;
        throw std::runtime_error{"the main process does not tell its time"};
      }
      if (SteadyClock::now() >= next) {
        link_.ask_clock();
        next += kAskFirst;
      }
      link_.update();
      std::this_thread::sleep_for(std::chrono::milliseconds{1});
    }
    if (end_signals::cause()) return false;
    const auto [offset, round_trip] = *link_.clock_ahead();
    if (round_trip > kMaxRoundTrip) {
      const std::string why = fmt::format(
          "its clock can be known to half of the round trip of a question only, which takes "
          "{:.1f} ms (at most {:g} ms)",
          to_seconds(round_trip) * 1e3, to_seconds(kMaxRoundTrip) * 1e3);
      say("stop " + why);
      tell_rest();
      throw std::runtime_error{why};
    }
    ahead_ = offset;
    say(
        fmt::format("note its clock was {:.3f} ms {} this one (round trip {:.3f} ms), and follows "
                    "it",
                    std::abs(to_seconds(offset)) * 1e3, offset > Duration{0} ? "behind" : "before",
                    to_seconds(round_trip) * 1e3));
    return true;
  }

  Duration main_offset() const { return clock_.unix_minus_monotonic() + ahead_; }

  void start_processes() {
    origin_.clock_offset = main_offset();
    followed_.emplace(origin_.clock_offset);
    for (const std::string& name : deployment_.processes()) {
      if (deployment_.host_of(name) != options_.host) continue;
      processes_.push_back(
          {name, start_process(name, process_arguments(options_, domain_, name, origin_))});
      console_.line("host", fmt::format("process '{}' is started", name));
    }
    say("joined");
    say("ready");
  }

  /// Passes on what was said since the last time, both ways, and tells who has ended.
  void pass_on() {
    while (const auto line = told()) told_end_ = told_end_ || *line == "end";
    for (Process& process : processes_) {
      while (const auto line = link_.receive(process.name)) process.started.control.send(*line);
      pass_to_main(process);
      int status = 0;
      if (process.ended || waitpid(process.started.pid, &status, WNOHANG) != process.started.pid) {
        continue;
      }
      pass_to_main(process);  // what it said before
      process.ended = true;
      well_ = well_ && WIFEXITED(status) && WEXITSTATUS(status) == 0;
      link_.send(process.name, "ended " + text_of_status(status));
    }
    const auto cause = end_signals::cause();
    if (cause && !std::exchange(told_stop_, true)) say("stop " + *cause);
  }

  void pass_to_main(Process& process) {
    while (const auto line = process.started.control.receive()) link_.send(process.name, *line);
  }

  void follow_clock() {
    const auto now = SteadyClock::now();
    if (now >= next_question_) {
      next_question_ = now + kAskEvery;
      link_.ask_clock();
    }
    const auto known = link_.clock_ahead();
    if (now < next_follow_ || !known || known->round_trip > kMaxRoundTrip) return;
    next_follow_ = now + kFollowEvery;
    ahead_ = known->offset;
    const Duration apart = std::chrono::abs(main_offset() - followed_->unix_minus_monotonic());
    followed_->follow(main_offset());
    // What is measured may be wrong by half of the round trip.
    if (apart > kMaxClockLag + known->round_trip / 2 && !std::exchange(told_stop_, true)) {
      const std::string why = fmt::format(
          "its clock has moved {:.1f} ms from that of the main process, faster than its processes "
          "can follow",
          to_seconds(apart) * 1e3);
      well_ = false;
      say("fault " + why);
      say("stop " + why);
    }
    const std::string line = fmt::format("clock {}", main_offset().count());
    for (Process& process : processes_) process.started.control.send(line);
  }

  /// True when the main process has ended all that runs here, or is gone.
  bool over() {
    const bool none_runs = std::ranges::all_of(processes_, &Process::ended);
    if (told_end_ && none_runs) return true;
    if (!link_.lost()) return false;
    if (well_) {
      console_.line("host", fmt::format("the main process fell silent for {:g} s: it is dead, or "
                                        "the network between is; what runs here comes to rest",
                                        to_seconds(HostLink::kSilence)));
    }
    well_ = false;
    return true;
  }

  /// Closes the ways to the processes that still run. Without a main process they come to rest and
  /// end by themselves; one that does not is killed.
  void take_leave() {
    if (told_end_) say("ended " + text_of_status(0));
    tell_rest();
    std::vector<pid_t> pids;
    for (const Process& process : processes_) {
      if (!process.ended) pids.push_back(process.started.pid);
    }
    processes_.clear();
    const auto deadline =
        SteadyClock::now() + std::chrono::duration_cast<SteadyClock::duration>(
                                 seconds(deployment_.stop_within_s + 2) * (kSanitized ? 5 : 1));
    while (!pids.empty()) {
      std::erase_if(pids, [](pid_t pid) { return waitpid(pid, nullptr, WNOHANG) == pid; });
      if (SteadyClock::now() > deadline) {
        for (const pid_t pid : pids) kill(pid, SIGKILL);
      }
      std::this_thread::sleep_for(kLook);
    }
  }

  /// Waits until the main process has got everything, but not for long.
  void tell_rest() {
    const auto deadline = SteadyClock::now() + std::chrono::seconds{1};
    while (!link_.all_arrived() && !link_.lost() && SteadyClock::now() < deadline) {
      link_.update();
      std::this_thread::sleep_for(kLook);
    }
  }

  RunOptions options_;  // some of which the main process tells
  const DeploymentConfig& deployment_;
  const int domain_;
  Console console_;
  SystemClock clock_;
  PluginPtr<Transport> transport_;
  HostLink link_;
  RunOptions::Origin origin_{};
  Duration ahead_{0};                    // the main process' clock, of ours
  std::optional<SystemClock> followed_;  // by which the processes go
  std::deque<Process> processes_;
  SteadyClock::time_point next_question_{}, next_follow_{};
  bool told_end_ = false, told_stop_ = false, well_ = true;
};

}  // namespace

int run_host(const RunOptions& options, const DeploymentConfig& deployment, int domain,
             PluginRegistry& plugins) {
  if (options.report || options.keep_running) {
    throw InvalidChoice(
        "--report and --keep-running belong to the main host, which has the figures of the run and "
        "ends it");
  }
  const auto lock = InstanceLock::take(
      fmt::format("deployment {} domain {} host {}", deployment.name, domain, options.host));
  if (!lock) {
    throw std::runtime_error{fmt::format("host '{}' of deployment '{}' already runs as {}",
                                         options.host, deployment.name, lock.error().text)};
  }
  end_signals::stop_in_order();
  return HostAgent{options, deployment, domain, plugins}.run();
}

}  // namespace armature
