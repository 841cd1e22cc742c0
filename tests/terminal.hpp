// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

namespace armature::test {

/// A program on a terminal of its own.
class Terminal {
 public:
  static constexpr std::chrono::seconds kShownWithin{60};

  explicit Terminal(const std::vector<std::string>& arguments) {
    const winsize size{.ws_row = 40, .ws_col = 160, .ws_xpixel = 0, .ws_ypixel = 0};
    std::vector<char*> words;
    for (const auto& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    pid_ = forkpty(&file_, nullptr, nullptr, &size);
    if (pid_ > 0) return;
    setenv("TERM", "vt100", 1);
    execv(words[0], words.data());
    _exit(127);
  }
  ~Terminal() {
    if (pid_ > 0) kill(pid_, SIGKILL);
    close(file_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  void type(const std::string& keys) const {
    EXPECT_EQ(write(file_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
  }
  void signal(int signal) const { kill(pid_, signal); }
  /// True once `text` has been shown after the last one that was waited for.
  bool shows(const std::string& text) {
    const auto end = std::chrono::steady_clock::now() + kShownWithin;
    while (std::chrono::steady_clock::now() < end) {
      if (const auto at = shown_.find(text); at != std::string::npos) {
        shown_.erase(0, at + text.size());
        return true;
      }
      if (!read_some()) return false;
    }
    return false;
  }
  /// Waits for the end of the program, which closes its side.
  int exit_code() {
    while (read_some()) continue;
    int status = 0;
    waitpid(std::exchange(pid_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  /// False when nothing will come any more.
  bool read_some() {
    pollfd input{.fd = file_, .events = POLLIN, .revents = 0};
    if (poll(&input, 1, 100) == 0) return true;
    char bytes[4096];
    const ssize_t count = read(file_, bytes, sizeof bytes);
    if (count <= 0) return false;
    shown_.append(bytes, static_cast<std::size_t>(count));
    return true;
  }

  int file_ = -1;
  pid_t pid_ = -1;
  std::string shown_;
};

}  // namespace armature::test
