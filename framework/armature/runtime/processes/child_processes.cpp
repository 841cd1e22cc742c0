// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/processes/child_processes.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>
#include <thread>
#include <utility>

#include "armature/bus/qos.hpp"
#include "armature/values/sanitizer.hpp"
#include "armature/values/spawn_plan.hpp"

namespace armature {
namespace {

/// What is moving in a process that has not said so yet.
const std::string kNotSaid = "?";

std::string text_of_status(int status) {
  if (WIFSIGNALED(status)) {
    return fmt::format("was killed by signal {} ({})", WTERMSIG(status),
                       strsignal(WTERMSIG(status)));
  }
  return fmt::format("ended with exit code {}", WEXITSTATUS(status));
}

}  // namespace

ChildProcesses::~ChildProcesses() {
  end([](const std::string&) { return true; });
}

void ChildProcesses::start(const std::string& name, std::vector<std::string> arguments,
                           OnFault on_loss) {
  constexpr int kControlFile = STDERR_FILENO + 1;
  auto [ours, theirs] = ControlChannel::make();
  const std::string program = "/proc/self/exe";
  arguments.insert(arguments.begin(), program);
  arguments.insert(arguments.end(), {std::string{kControlOption}, std::to_string(kControlFile)});
  // Ctrl-C reaches the main process, which ends the others in order. Not fork: afterwards a thread
  // of this process would pay for every page that it touches.
  SpawnPlan plan;
  plan.hand_over(theirs.file(), kControlFile).own_group().unblock_signals();
  pid_t pid = 0;
  if (const int error = plan.start(program, arguments, pid)) {
    throw std::system_error(error, std::generic_category(), "cannot start " + name);
  }
  children_.push_back({.name = name, .pid = pid, .on_loss = on_loss, .control = std::move(ours)});
}

void ChildProcesses::update() {
  for (Child& child : children_) {
    hear(child);
    watch(child);
  }
}

void ChildProcesses::hear(Child& child) {
  while (const auto line = child.control.receive()) {
    const std::size_t space = line->find(' ');
    const std::string word = line->substr(0, space);
    const std::string text = space == std::string::npos ? "" : line->substr(space + 1);
    if (word == "joined") child.joined = true;
    if (word == "waiting") child.waiting = text;
    if (word == "ready") child.ready = true;
    if (word == "stop") {
      child.stop_cause = fmt::format("process '{}': {}", child.name, text);
      child.moving = kNotSaid;
    }
    if (word == "moving") child.moving = text;
    if (word == "timing") child.timing.push_back(text);
    if (word == "fault") faults_.push_back(fmt::format("process '{}': {}", child.name, text));
  }
}

void ChildProcesses::watch(Child& child) {
  int status = 0;
  while (!child.ended &&
         waitpid(child.pid, &status, WNOHANG | WUNTRACED | WCONTINUED) == child.pid) {
    if (WIFSTOPPED(status)) {
      child.halted_at = SteadyClock::now();
    } else if (WIFCONTINUED(status)) {
      on_continued(child);
    } else {
      on_ended(child, status);
    }
  }
}

void ChildProcesses::on_continued(Child& child) {
  if (!child.halted_at) return;
  const Duration halted = SteadyClock::now() - *std::exchange(child.halted_at, std::nullopt);
  if (halted <= settings(QosProfile::command).liveliness_lease) return;
  faults_.push_back(fmt::format("process '{}' (pid {}) fell silent: it was stopped for {:.1f} s",
                                child.name, child.pid, to_seconds(halted)));
}

void ChildProcesses::on_ended(Child& child, int status) {
  hear(child);  // what it said before
  child.ended = true;
  child.moving.clear();
  const bool well = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (child.told_end && (well || WIFEXITED(status))) return;  // its faults it has told
  const std::string lost =
      fmt::format("process '{}' (pid {}) {}", child.name, child.pid, text_of_status(status));
  if (begun_ && !child.told_end && child.on_loss == OnFault::isolate) {
    isolated_.push_back(lost + ", isolated: the run goes on without it");
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
    child.control.send(line);
    const bool stops_by_itself = child.ended || !child.stop_cause.empty();
    if (line.starts_with("stop") && !stops_by_itself) child.moving = kNotSaid;
  }
}

std::optional<std::string> ChildProcesses::not_joined() const {
  const auto late = std::ranges::find(children_, false, &Child::joined);
  return late == children_.end() ? std::nullopt : std::optional{late->name};
}

std::optional<std::string> ChildProcesses::waiting() const {
  const auto late = std::ranges::find(children_, false, &Child::ready);
  if (late == children_.end()) return std::nullopt;
  if (!late->waiting.empty()) return late->waiting;
  return fmt::format("process '{}' has not said that it is ready", late->name);
}

std::optional<std::string> ChildProcesses::stop_cause() const {
  for (const Child& child : children_) {
    if (!child.stop_cause.empty()) return child.stop_cause;
  }
  return std::nullopt;
}

std::optional<std::string> ChildProcesses::next_isolated() {
  if (isolated_.empty()) return std::nullopt;
  std::string lost = std::move(isolated_.front());
  isolated_.pop_front();
  return lost;
}

std::vector<std::string> ChildProcesses::moving() const {
  std::vector<std::string> moving;
  for (const Child& child : children_) {
    if (child.moving.empty()) continue;
    moving.push_back(child.moving == kNotSaid
                         ? fmt::format("process '{}'", child.name)
                         : fmt::format("'{}' in process '{}'", child.moving, child.name));
  }
  return moving;
}

void ChildProcesses::add_timing(RunTiming& timing) const {
  for (const Child& child : children_) {
    for (const std::string& line : child.timing) add_line(timing, child.name, line);
  }
}

void ChildProcesses::end(const std::function<bool(const std::string& name)>& which) {
  constexpr std::chrono::seconds kTimeout{kSanitized ? 15 : 3};
  const auto is_meant = [&](const Child& child) { return !child.ended && which(child.name); };
  for (Child& child : children_) {
    if (!is_meant(child)) continue;
    child.told_end = true;
    child.control.send("end");
  }
  const auto deadline = SteadyClock::now() + kTimeout;
  while (std::ranges::any_of(children_, is_meant)) {
    update();
    if (SteadyClock::now() > deadline) {
      for (const Child& child : children_) {
        if (is_meant(child)) kill(child.pid, SIGKILL);
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds{5});
  }
}

}  // namespace armature
