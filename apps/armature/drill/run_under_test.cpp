// SPDX-License-Identifier: Apache-2.0
#include "drill/run_under_test.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include "armature/values/spawn_plan.hpp"

namespace armature::drill {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kPause{5};

/// What stands behind --process on the command line of that process; empty: nothing.
std::string process_name(pid_t pid) {
  std::ifstream file{"/proc/" + std::to_string(pid) + "/cmdline"};
  for (std::string word; std::getline(file, word, '\0');) {
    if (word == "--process" && std::getline(file, word, '\0')) return word;
  }
  return {};
}

bool is_there(pid_t pid) {
  std::ifstream file{"/proc/" + std::to_string(pid) + "/stat"};
  std::string number, name, state;
  return file >> number >> name >> state && state != "Z";
}

}  // namespace

RunUnderTest::RunUnderTest(std::vector<std::string> arguments, const std::stop_token& stop) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw std::system_error(errno, std::generic_category(), "cannot make a pipe");
  }
  terminal_ = ends[0];
  arguments.insert(arguments.begin(), "armature");
  output_ = memfd_create("armature run", MFD_CLOEXEC);
  SpawnPlan plan;
  plan.give_nothing(STDIN_FILENO);
  plan.hand_over(output_, STDOUT_FILENO).hand_over(ends[1], STDERR_FILENO);
  // Ctrl-C reaches the drill alone, and a run hears the signals that the drill ignores.
  plan.own_group().default_signals();
  const int error = plan.start("/proc/self/exe", arguments, pid_);
  close(ends[1]);
  if (error != 0) {
    close(terminal_);
    close(output_);
    throw std::system_error(error, std::generic_category(), "cannot start a run");
  }
  processes_["main"] = pid_;
  reader_ = std::jthread{[this](std::stop_token end) { read_lines(end); }};
  on_stop_.emplace(stop, [this] { interrupt(); });
}

RunUnderTest::~RunUnderTest() {
  on_stop_.reset();
  if (!all_ended()) {
    find_processes();
    for (const auto& [name, pid] : processes_) {
      if (is_there(pid)) kill(pid, SIGKILL);
    }
    if (!exit_code_) waitpid(pid_, nullptr, 0);
  }
  reader_.request_stop();
  reader_.join();
  if (terminal_ >= 0) close(terminal_);
  close(output_);
}

void RunUnderTest::find_processes() {
  if (!runs()) return;
  const std::string main = std::to_string(pid_);
  std::ifstream children{"/proc/" + main + "/task/" + main + "/children"};
  for (pid_t pid = 0; children >> pid;) {
    if (const std::string name = process_name(pid); !name.empty()) processes_[name] = pid;
  }
}

bool RunUnderTest::signal(const std::string& process, int number) {
  const auto found = processes_.find(process);
  return found != processes_.end() && is_there(found->second) && kill(found->second, number) == 0;
}

void RunUnderTest::interrupt() {
  const std::scoped_lock lock{process_mutex_};
  if (!exit_code_) kill(pid_, SIGINT);
}

bool RunUnderTest::runs() {
  const std::scoped_lock lock{process_mutex_};
  int status = 0;
  if (!exit_code_ && waitpid(pid_, &status, WNOHANG) == pid_) {
    exit_code_ = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  }
  return !exit_code_;
}

bool RunUnderTest::all_ended() {
  return !runs() && std::ranges::none_of(processes_, [](const auto& process) {
    return process.first != "main" && is_there(process.second);
  });
}

bool RunUnderTest::ends_within(milliseconds timeout) {
  for (const auto end = steady_clock::now() + timeout; !all_ended();) {
    if (steady_clock::now() > end) return false;
    std::this_thread::sleep_for(kPause);
  }
  // What it said at last is still on its way.
  for (const auto end = steady_clock::now() + milliseconds{200}; steady_clock::now() < end;) {
    const std::scoped_lock lock{mutex_};
    if (read_to_end_ || reading_ != Reading::on) break;
  }
  return true;
}

void RunUnderTest::read_lines(std::stop_token stop) {
  std::array<char, 4096> buffer;
  while (!stop.stop_requested()) {
    {
      const std::scoped_lock lock{mutex_};
      if (reading_ == Reading::closed || read_to_end_) return;
      pollfd ready{terminal_, POLLIN, 0};
      if (reading_ == Reading::on && poll(&ready, 1, 0) > 0) {
        const ssize_t size = ::read(terminal_, buffer.data(), buffer.size());
        read_to_end_ = size == 0;
        if (size > 0) {
          take({buffer.data(), static_cast<std::size_t>(size)});
          continue;
        }
      }
    }
    std::this_thread::sleep_for(kPause);
  }
}

void RunUnderTest::take(std::string_view text) {
  unfinished_ += text;
  for (std::size_t end; (end = unfinished_.find('\n')) != std::string::npos;) {
    lines_.push_back(unfinished_.substr(0, end));
    unfinished_.erase(0, end + 1);
  }
}

std::optional<std::string> RunUnderTest::line_with(const std::string& text) const {
  const std::scoped_lock lock{mutex_};
  for (const std::string& line : lines_) {
    if (line.find(text) != std::string::npos) return line;
  }
  return std::nullopt;
}

std::ptrdiff_t RunUnderTest::count_lines(const std::string& component,
                                         const std::string& text) const {
  const std::string said_by = "] " + component + ' ';
  const std::scoped_lock lock{mutex_};
  return std::ranges::count_if(lines_, [&](const std::string& line) {
    return line.find(said_by) != std::string::npos && line.find(text) != std::string::npos;
  });
}

std::optional<std::string> RunUnderTest::wait_for_line(const std::string& text,
                                                       milliseconds timeout) {
  for (const auto end = steady_clock::now() + timeout;;) {
    if (auto line = line_with(text)) return line;
    if (steady_clock::now() > end || !runs()) return line_with(text);
    std::this_thread::sleep_for(kPause);
  }
}

std::string RunUnderTest::output() const {
  std::string text;
  std::array<char, 4096> block;
  for (ssize_t size;
       (size = pread(output_, block.data(), block.size(), static_cast<off_t>(text.size()))) > 0;) {
    text.append(block.data(), static_cast<std::size_t>(size));
  }
  return text;
}

std::string RunUnderTest::last_line() const {
  const std::scoped_lock lock{mutex_};
  return lines_.empty() ? "nothing" : lines_.back();
}

void RunUnderTest::close_terminal() {
  const std::scoped_lock lock{mutex_};
  reading_ = Reading::closed;
  close(std::exchange(terminal_, -1));
}

void RunUnderTest::fill_terminal() {
  {
    const std::scoped_lock lock{mutex_};
    reading_ = Reading::paused;
  }
  // Another description of the pipe: that the run writes to must go on waiting for room.
  const std::string pipe = "/proc/self/fd/" + std::to_string(terminal_);
  const int writes = open(pipe.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
  const std::string filler(4096, '.');
  while (::write(writes, filler.data(), filler.size()) > 0) {
  }
  while (::write(writes, "\n", 1) > 0) {
  }
  close(writes);
}

}  // namespace armature::drill
