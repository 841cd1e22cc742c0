// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/child_processes.hpp"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <system_error>
#include <thread>

namespace armature {
namespace {

std::string describe(int status) {
  if (WIFSIGNALED(status)) return fmt::format("was killed ({})", strsignal(WTERMSIG(status)));
  return fmt::format("ended with exit code {}", WEXITSTATUS(status));
}

}  // namespace

void ChildProcesses::start(const std::string& name, const std::vector<std::string>& arguments) {
  std::vector<char*> argv;
  std::string program = "/proc/self/exe";
  argv.push_back(program.data());
  std::vector<std::string> copies = arguments;
  for (std::string& argument : copies) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), "cannot start " + name);
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    setpgid(0, 0);  // Ctrl-C reaches the main process, which ends the others in order
    if (getppid() != parent) _exit(1);
    execv(program.c_str(), argv.data());
    _exit(127);
  }
  children_.push_back({name, child});
}

std::optional<ChildProcesses::Ending> ChildProcesses::ended() {
  for (auto child = children_.begin(); child != children_.end(); ++child) {
    int status = 0;
    if (waitpid(child->pid, &status, WNOHANG) != child->pid) continue;
    Ending ending{
        .well = WIFEXITED(status) && WEXITSTATUS(status) == 0,
        .text = fmt::format("process '{}' (pid {}) {}", child->name, child->pid, describe(status))};
    children_.erase(child);
    return ending;
  }
  return std::nullopt;
}

void ChildProcesses::stop() {
  for (const Child& child : children_) kill(child.pid, SIGTERM);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds{3};
  for (const Child& child : children_) {
    while (waitpid(child.pid, nullptr, WNOHANG) == 0) {
      if (std::chrono::steady_clock::now() > deadline) kill(child.pid, SIGKILL);
      std::this_thread::sleep_for(std::chrono::milliseconds{5});
    }
  }
  children_.clear();
}

}  // namespace armature
