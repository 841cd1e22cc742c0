// SPDX-License-Identifier: Apache-2.0
#include "command.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "armature/values/file_content.hpp"
#include "armature/values/sanitizer.hpp"

namespace armature::test {
namespace {

using std::chrono::steady_clock;

void redirect(const std::string& file, int flags, int to) {
  const int from = open(file.c_str(), flags, 0600);
  if (from < 0 || dup2(from, to) < 0) _exit(126);
}

bool runs(pid_t pid) {
  std::ifstream stat{"/proc/" + std::to_string(pid) + "/stat"};
  std::string number, name, state;
  return stat >> number >> name >> state && state != "Z";
}

/// When `timeout` is over; a program with a sanitizer takes several times as long.
steady_clock::time_point end_of(std::chrono::seconds timeout) {
  return steady_clock::now() + timeout * (kSanitized ? 5 : 1);
}

}  // namespace

Command::Command(const std::vector<std::string>& arguments, const Options& options) {
  std::string pattern = (std::filesystem::temp_directory_path() / "armature-test-XXXXXX").string();
  if (!mkdtemp(pattern.data())) throw std::runtime_error("cannot make " + pattern);
  folder_ = pattern;
  std::ofstream{folder_ + "/in"} << options.input;
  std::vector<std::string> copies = arguments;
  std::vector<char*> argv;
  for (std::string& argument : copies) argv.push_back(argument.data());
  argv.push_back(nullptr);
  pid_ = fork();
  if (pid_ != 0) return;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const auto& [name, value] : options.environment) setenv(name.c_str(), value.c_str(), 1);
  redirect(folder_ + "/in", O_RDONLY, STDIN_FILENO);
  redirect(folder_ + "/out", O_WRONLY | O_CREAT | O_TRUNC, STDOUT_FILENO);
  redirect(folder_ + "/err", O_WRONLY | O_CREAT | O_TRUNC, STDERR_FILENO);
  execv(argv[0], argv.data());
  _exit(127);
}

Command::~Command() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  std::filesystem::remove_all(folder_);
}

pid_t Command::child() const {
  const std::string pid = std::to_string(pid_);
  std::ifstream children{"/proc/" + pid + "/task/" + pid + "/children"};
  pid_t child = 0;
  children >> child;
  return child;
}

void Command::signal(int number) const { kill(pid_, number); }
std::string Command::out() const { return content_of(folder_ + "/out"); }
std::string Command::err() const { return content_of(folder_ + "/err"); }

bool Command::wait_for(const std::string& file, const std::string& text,
                       std::chrono::seconds timeout) const {
  for (const auto end = end_of(timeout); steady_clock::now() < end;) {
    if (content_of(folder_ + file).find(text) != std::string::npos) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  }
  return false;
}

bool Command::wait_for_err(const std::string& text, std::chrono::seconds timeout) const {
  return wait_for("/err", text, timeout);
}
bool Command::wait_for_out(const std::string& text, std::chrono::seconds timeout) const {
  return wait_for("/out", text, timeout);
}

CommandResult Command::finish(std::chrono::seconds timeout) {
  CommandResult result;
  const auto end = end_of(timeout);
  int status = 0;
  while (waitpid(pid_, &status, WNOHANG) == 0) {
    if (steady_clock::now() > end && !result.timed_out) {
      result.timed_out = true;
      kill(pid_, SIGKILL);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds{2});
  }
  pid_ = -1;
  result.exit_code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  result.out = out();
  result.err = err();
  return result;
}

bool ends_within(pid_t pid, std::chrono::seconds timeout) {
  for (const auto end = end_of(timeout); runs(pid);) {
    if (steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  }
  return true;
}

CommandResult run_command(const std::vector<std::string>& arguments,
                          const Command::Options& options, std::chrono::seconds timeout) {
  return Command{arguments, options}.finish(timeout);
}

std::string armature() { return std::string{ARMATURE_BINARY_DIR} + "/bin/armature"; }
std::string source_file(const std::string& path) {
  return std::string{ARMATURE_SOURCE_DIR} + "/" + path;
}

}  // namespace armature::test
