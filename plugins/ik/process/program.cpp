// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sched.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <thread>
#include <utility>

#include "armature/values/spawn_plan.hpp"

namespace armature::ik::process {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kPiece = 16384;  // bytes read at a time
constexpr double kGrace_s = 0.2;       // to end by itself when its input is closed
constexpr double kFate_s = 0.1;        // to be gone when its output is closed

Clock::duration duration_of(double seconds) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>{seconds});
}

/// Ours and theirs of one standard stream.
struct Ends {
  FileDescriptor ours, theirs;
  bool open() const { return ours && theirs; }
};

/// A socket, so that writing to a program that is gone is an error and not a signal.
Ends input_ends() {
  std::array<int, 2> fd{-1, -1};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, fd.data()) != 0) return {};
  return {FileDescriptor{fd[0]}, FileDescriptor{fd[1]}};
}

Ends output_ends() {
  std::array<int, 2> fd{-1, -1};
  if (pipe2(fd.data(), O_CLOEXEC) != 0) return {};
  Ends ends{FileDescriptor{fd[0]}, FileDescriptor{fd[1]}};
  if (ends.open()) ends.ours.do_not_block();
  return ends;
}

bool has_real_time_priority() {
  const int policy = sched_getscheduler(0);
  return policy == SCHED_FIFO || policy == SCHED_RR;
}

}  // namespace

Expected<std::unique_ptr<Program>> Program::start(const Command& command) {
  Ends in = input_ends(), out = output_ends(), err = output_ends();
  if (!in.open() || !out.open() || !err.open()) {
    return refuse(fmt::format("cannot be started: {}", std::strerror(errno)));
  }
  pid_t pid = -1;
  SpawnPlan plan;
  plan.hand_over(in.theirs.get(), STDIN_FILENO)
      .hand_over(out.theirs.get(), STDOUT_FILENO)
      .hand_over(err.theirs.get(), STDERR_FILENO);
  plan.own_group().unblock_signals().default_signals();
  if (!command.folder.empty()) plan.in_folder(command.folder);
  if (has_real_time_priority()) plan.normal_priority();
  if (const int why = plan.start(command.file, command.words, pid); why != 0) {
    return refuse(fmt::format("cannot be started: {}", std::strerror(why)));
  }
  ErrorRelay errors{std::move(err.ours), "ik/process (" + command.text() + ")"};
  return std::unique_ptr<Program>{
      new Program{pid, std::move(in.ours), std::move(out.ours), std::move(errors)}};
}

Program::Program(pid_t pid, FileDescriptor to, FileDescriptor from, ErrorRelay errors)
    : pid_{pid}, to_{std::move(to)}, from_{std::move(from)}, errors_{std::move(errors)} {
  received_.reserve(kPiece);  // not in steps that depend on how the program's words come in
}

Program::~Program() { end(kGrace_s); }

void Program::kill() { end(0); }

Expected<std::string> Program::ask(std::string_view line, double timeout_s) {
  const auto end = Clock::now() + duration_of(timeout_s);
  std::string unsent = std::string{line} + "\n";
  for (;;) {
    if (auto answer = received_line()) {
      errors_.forget();
      return *answer;
    }
    if (received_.size() > kLongestAnswer) {
      return failed(fmt::format("answers with more than {} bytes in a line", kLongestAnswer));
    }
    const std::chrono::duration<double, std::milli> left = end - Clock::now();
    if (left.count() <= 0) return failed(fmt::format("gave no answer within {} s", timeout_s));
    std::array<pollfd, 3> files{pollfd{from_.get(), POLLIN, 0},
                                pollfd{errors_.descriptor(), POLLIN, 0},
                                pollfd{unsent.empty() ? -1 : to_.get(), POLLOUT, 0}};
    poll(files.data(), files.size(), static_cast<int>(std::ceil(left.count())));
    if (files[1].revents != 0) errors_.pass_on();
    if (files[2].revents != 0) send(unsent);
    if (files[0].revents != 0 && !receive()) return failed(fate());
  }
}

std::optional<std::string> Program::received_line() {
  const std::size_t end = received_.find('\n');
  if (end == std::string::npos || end > kLongestAnswer) return std::nullopt;
  std::string line = received_.substr(0, end);
  received_.erase(0, end + 1);
  return line;
}

/// What cannot be sent to a program that is gone is dropped: its output tells what became of it.
void Program::send(std::string& unsent) {
  const ssize_t n = ::send(to_.get(), unsent.data(), unsent.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  if (n >= 0) {
    unsent.erase(0, static_cast<std::size_t>(n));
  } else if (errno != EAGAIN && errno != EINTR) {
    unsent.clear();
  }
}

bool Program::receive() {
  std::array<char, kPiece> buffer;
  const ssize_t n = read(from_.get(), buffer.data(), buffer.size());
  if (n > 0) received_.append(buffer.data(), static_cast<std::size_t>(n));
  return n > 0 || (n < 0 && (errno == EAGAIN || errno == EINTR));
}

tl::unexpected<Reason> Program::failed(std::string what) {
  errors_.finish();
  if (!errors_.last_words().empty()) what += "; its last words: " + errors_.last_words();
  return refuse(std::move(what));
}

/// What became of a program whose output is closed.
std::string Program::fate() {
  if (!ends_within(kFate_s)) return "closed its output";
  siginfo_t info{};
  waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT);
  if (info.si_code == CLD_EXITED) return fmt::format("ended with exit code {}", info.si_status);
  const char* name = sigdescr_np(info.si_status);
  if (!name) return "ended";  // somebody else has asked how
  return fmt::format("was killed by signal {} ({})", info.si_status, name);
}

bool Program::has_ended() const {
  siginfo_t info{};
  const int result = waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT);
  return result != 0 || info.si_pid == pid_;
}

bool Program::ends_within(double timeout_s) const {
  for (const auto end = Clock::now() + duration_of(timeout_s); !has_ended();) {
    if (Clock::now() >= end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
  }
  return true;
}

void Program::end(double timeout_s) {
  if (pid_ < 0) return;
  to_.reset();
  from_.reset();
  if (timeout_s > 0) ends_within(timeout_s);
  ::kill(-pid_, SIGKILL);  // and what it has started; the group is there until it is reaped
  while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  errors_.finish();
}

}  // namespace armature::ik::process
