// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/processes/child_processes.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <thread>
#include <utility>

#include "armature/bus/qos.hpp"
#include "armature/runtime/processes/host_channel.hpp"
#include "armature/runtime/processes/started_process.hpp"
#include "armature/values/sanitizer.hpp"

namespace armature {
namespace {

/// What is moving in a process that has not said so yet.
const std::string kNotSaid = "?";

/// The first word of a line, and what follows it.
std::pair<std::string, std::string> split(const std::string& line) {
  const std::size_t space = line.find(' ');
  if (space == std::string::npos) return {line, ""};
  return {line.substr(0, space), line.substr(space + 1)};
}

template <class T>
std::optional<T> next_of(std::deque<T>& waiting) {
  if (waiting.empty()) return std::nullopt;
  T next = std::move(waiting.front());
  waiting.pop_front();
  return next;
}

}  // namespace

ChildProcesses::~ChildProcesses() {
  end([](const std::string&) { return true; });
}

void ChildProcesses::start(const std::string& name, std::vector<std::string> arguments,
                           OnFault on_loss) {
  auto [pid, control] = start_process(name, std::move(arguments));
  children_.push_back({.name = name,
                       .label = fmt::format("process '{}'", name),
                       .on_loss = on_loss,
                       .control = std::make_unique<SocketChannel>(std::move(control)),
                       .pid = pid});
}

void ChildProcesses::expect(Host host) {
  HostLink* link = hosts_.emplace_back(std::move(host.link)).get();
  for (const auto& [name, on_loss] : host.processes) {
    children_.push_back({.name = name,
                         .label = fmt::format("process '{}' of host '{}'", name, link->host()),
                         .on_loss = on_loss,
                         .control = std::make_unique<HostChannel>(*link, name),
                         .host = link});
  }
  children_.push_back({.name = "",
                       .label = fmt::format("host '{}'", link->host()),
                       .on_loss = OnFault::stop,
                       .control = std::make_unique<HostChannel>(*link, HostLink::kAgent),
                       .host = link,
                       .fingerprint = std::move(host.fingerprint),
                       .welcome = std::move(host.welcome)});
}

void ChildProcesses::welcome(Child& agent, const std::string& fingerprint) {
  if (fingerprint == agent.fingerprint) return agent.control->send(agent.welcome);
  const std::string why = fmt::format(
      "{} has another configuration (fingerprint {:.8}, here {:.8}): start it with the same file, "
      "overlays and --set",
      agent.label, fingerprint, agent.fingerprint);
  agent.control->send("refuse " + why);
  agent.host->update();
  agent.host->turn_away();
  notes_.push_back(why);
}

void ChildProcesses::update() {
  const auto now = SteadyClock::now();
  const Duration still = now - std::exchange(updated_, now).value_or(now);
  // A host that is lost later than that is lost for another reason.
  stood_still_ = still > HostLink::kSilence ? still : std::max(stood_still_ - still, Duration{0});
  for (const auto& host : hosts_) {
    host->update();
    if (host->is_doubled() && doubled_.insert(host->host()).second) {
      notes_.push_back(
          fmt::format("another program answers as host '{}', too; it waits until this run is over",
                      host->host()));
    }
  }
  for (Child& child : children_) {
    hear(child);
    watch(child);
  }
}

void ChildProcesses::hear(Child& child) {
  while (const auto line = child.control->receive()) {
    const auto [word, text] = split(*line);
    if (word == "joined") child.joined = true;
    if (word == "waiting") child.waiting = text;
    if (word == "ready") child.ready = true;
    if (word == "over") scenario_over_ = true;
    if (word == "stop") {
      child.stop_cause = fmt::format("{}: {}", child.label, text);
      if (!child.is_agent()) child.moving = kNotSaid;
    }
    if (word == "moving") child.moving = text;
    if (word == "trouble") troubles_.push_back(Time{std::atoll(text.c_str())});
    if (word == "timing") child.timing.push_back(text);
    if (word == "unwell") unwell_.push_back(text);
    if (word == "writing") child.writes_since = SteadyClock::now();
    if (word == "wrote") written_.push_back(text);
    if (word == "failed" && !failed_) failed_ = split(text);
    if (word == "fault") {
      child.told_fault = true;
      faults_.push_back(fmt::format("{}: {}", child.label, text));
    }
    if (word == "here") return welcome(child, text);
    if (word == "note") notes_.push_back(fmt::format("{}: {}", child.label, text));
    if (word == "ended") on_ended(child, text);
  }
}

void ChildProcesses::watch(Child& child) {
  if (child.host && !child.ended && child.control->lost()) {
    on_ended(child,
             stood_still_ > HostLink::kSilence
                 ? fmt::format("was lost: this process stood still for {:.1f} s, and is taken for "
                               "dead there after {:g} s",
                               to_seconds(stood_still_), to_seconds(HostLink::kSilence))
                 : fmt::format("fell silent for {:g} s: it is dead, or the network between is",
                               to_seconds(HostLink::kSilence)));
  }
  int status = 0;
  pid_t changed = 0;
  while (child.pid > 0 && !child.ended &&
         (changed = waitpid(child.pid, &status, WNOHANG | WUNTRACED | WCONTINUED)) == child.pid) {
    if (WIFSTOPPED(status)) {
      child.halted_at = SteadyClock::now();
    } else if (WIFCONTINUED(status)) {
      on_continued(child);
    } else {
      hear(child);  // what it said before
      on_ended(child, text_of_status(status));
    }
  }
  // A library of a vendor may ignore SIGCHLD, or wait for every child.
  if (changed < 0 && errno == ECHILD) {
    hear(child);
    on_ended(child, "has ended, and something else in this process took its exit code");
  }
}

void ChildProcesses::on_continued(Child& child) {
  if (!child.halted_at) return;
  const Duration halted = SteadyClock::now() - *std::exchange(child.halted_at, std::nullopt);
  if (halted <= settings(QosProfile::command).liveliness_lease.value()) return;
  faults_.push_back(fmt::format("{} (pid {}) fell silent: it was stopped for {:.1f} s", child.label,
                                child.pid, to_seconds(halted)));
}

void ChildProcesses::on_ended(Child& child, const std::string& how) {
  child.ended = true;
  child.moving.clear();
  const bool is_accounted_for =
      how == text_of_status(0) || (child.told_fault && how.starts_with("ended"));
  if (child.told_end && is_accounted_for) return;
  const std::string pid = child.pid > 0 ? fmt::format(" (pid {})", child.pid) : "";
  const std::string lost = fmt::format("{}{} {}", child.label, pid, how);
  if (begun_ && !child.told_end && child.on_loss == OnFault::isolate) {
    notes_.push_back(lost + ", isolated: the run goes on without it");
    faults_.push_back(lost + " (the run went on without it)");
    return;
  }
  child.stop_cause = lost;
  faults_.push_back(lost);
}

void ChildProcesses::begin() {
  send("start");
  begun_ = true;
}

void ChildProcesses::send(std::string_view line) {
  for (Child& child : children_) {
    child.control->send(line);
    const bool stops_by_itself = child.is_agent() || child.ended || !child.stop_cause.empty();
    if (line.starts_with("stop") && !stops_by_itself) child.moving = kNotSaid;
  }
}

std::optional<std::string> ChildProcesses::missing_host() const {
  const auto missing =
      std::ranges::find_if(hosts_, [](const auto& link) { return link->other().empty(); });
  return missing == hosts_.end() ? std::nullopt : std::optional{(*missing)->host()};
}

std::optional<std::string> ChildProcesses::not_joined() const {
  const auto late = std::ranges::find(children_, false, &Child::joined);
  return late == children_.end() ? std::nullopt : std::optional{late->label};
}

std::optional<std::string> ChildProcesses::waiting() const {
  const auto late = std::ranges::find(children_, false, &Child::ready);
  if (late == children_.end()) return std::nullopt;
  if (!late->waiting.empty()) return late->waiting;
  return late->label + " has not said that it is ready";
}

std::optional<std::string> ChildProcesses::stop_cause() const {
  for (const Child& child : children_) {
    if (!child.stop_cause.empty()) return child.stop_cause;
  }
  return std::nullopt;
}

std::optional<std::string> ChildProcesses::next_note() { return next_of(notes_); }

std::optional<Time> ChildProcesses::next_trouble() { return next_of(troubles_); }

std::vector<std::string> ChildProcesses::moving() const {
  std::vector<std::string> moving;
  for (const Child& child : children_) {
    if (child.moving.empty()) continue;
    moving.push_back(child.moving == kNotSaid
                         ? child.label
                         : fmt::format("'{}' in {}", child.moving, child.label));
  }
  return moving;
}

void ChildProcesses::add_timing(RunTiming& timing) const {
  for (const Child& child : children_) {
    for (const std::string& line : child.timing) add_line(timing, child.name, line);
  }
}

/// The agent of a host passes on what its processes say, and ends when they have.
bool ChildProcesses::may_end(const Child& child) const {
  return !child.is_agent() || std::ranges::all_of(children_, [&](const Child& other) {
    return other.host != child.host || other.is_agent() || other.ended;
  });
}

void ChildProcesses::give_up(Child& child, std::chrono::seconds timeout) {
  if (child.pid > 0) {
    kill(child.pid, SIGKILL);
  } else {
    on_ended(child, fmt::format("has not ended within {} s", timeout.count()));
  }
}

void ChildProcesses::end(const std::function<bool(const std::string& name)>& which) {
  constexpr std::chrono::seconds kTimeout{kSanitized ? 15 : 3};
  constexpr std::chrono::seconds kFilesTimeout{kSanitized ? 50 : 10};
  const auto is_meant = [&](const Child& child) {
    const bool has_come = !child.host || !child.host->other().empty();
    return has_come && !child.ended && which(child.name) && may_end(child);
  };
  auto deadline = SteadyClock::now() + kTimeout;
  while (std::ranges::any_of(children_, is_meant)) {
    for (Child& child : children_) {
      if (!is_meant(child) || std::exchange(child.told_end, true)) continue;
      child.control->send("end");
      deadline = SteadyClock::now() + kTimeout;
    }
    update();
    for (Child& child : children_) {
      const auto now = SteadyClock::now();
      const bool writes = child.writes_since && now - *child.writes_since < kFilesTimeout;
      if (is_meant(child) && now > deadline && !writes) give_up(child, kTimeout);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds{5});
  }
}

}  // namespace armature
