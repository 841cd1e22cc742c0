// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugins/plugin_trial.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <tuple>
#include <vector>

#include "armature/runtime/plugins/library_folder.hpp"
#include "armature/values/sanitizer.hpp"
#include "armature/values/spawn_plan.hpp"

namespace armature {
namespace {

/// The environment of this process, in which our own libraries are found besides: the program that
/// tries a plugin has not loaded them as this one has.
std::vector<std::string> environment_of_trial() {
  constexpr std::string_view kPath = "LD_LIBRARY_PATH=";
  std::string path = std::string{kPath} + library_folder().string();
  std::vector<std::string> variables;
  for (char** variable = environ; *variable; ++variable) {
    const std::string_view text{*variable};
    if (text.starts_with(kPath)) {
      path += fmt::format(":{}", text.substr(kPath.size()));
    } else {
      variables.emplace_back(text);
    }
  }
  variables.push_back(path);
  return variables;
}

/// Nobody tells a program that ignores the ends of its children, or whose parent did, how they end.
void hear_of_ends() {
  struct sigaction now {};
  if (sigaction(SIGCHLD, nullptr, &now) == 0 && now.sa_handler == SIG_IGN) {
    std::signal(SIGCHLD, SIG_DFL);
  }
}

/// How the child ended; nothing when it took too long and was killed.
std::optional<int> ending_of(pid_t child, std::chrono::milliseconds limit) {
  constexpr std::chrono::milliseconds kPause{1};
  const auto end = std::chrono::steady_clock::now() + limit * (kSanitized ? 5 : 1);
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > end) {
      kill(child, SIGKILL);
      waitpid(child, nullptr, 0);
      return std::nullopt;
    }
    std::this_thread::sleep_for(kPause);
  }
  return status;
}

/// The libraries that could be loaded when they were tried, as the files that they were.
class Tried {
 public:
  bool has(const std::filesystem::path& file) const {
    const std::lock_guard lock{mutex_};
    const auto state = state_of(file);
    return state && files_.contains(*state);
  }
  void add(const std::filesystem::path& file) {
    const std::lock_guard lock{mutex_};
    if (const auto state = state_of(file)) files_.insert(*state);
  }

 private:
  using State = std::tuple<dev_t, ino_t, off_t, time_t, long>;

  static std::optional<State> state_of(const std::filesystem::path& file) {
    struct stat state {};
    if (stat(file.c_str(), &state) != 0) return std::nullopt;
    return State{state.st_dev, state.st_ino, state.st_size, state.st_mtim.tv_sec,
                 state.st_mtim.tv_nsec};
  }

  mutable std::mutex mutex_;
  std::set<State> files_;
};

Tried& tried() {
  static Tried libraries;
  return libraries;
}

/// Loads `files` in that order in a program of its own.
Expected<void> load_elsewhere(const std::vector<std::filesystem::path>& files,
                              std::chrono::milliseconds limit) {
  const std::string program = library_folder() / "armature" / "load_plugin";
  SpawnPlan plan;
  plan.give_nothing(STDIN_FILENO).give_nothing(STDOUT_FILENO).give_nothing(STDERR_FILENO);
  plan.own_group().unblock_signals().default_signals();
  std::vector<std::string> command{program, std::to_string(getpid())};
  for (const auto& file : files) command.push_back(file.string());
  hear_of_ends();
  pid_t child = -1;
  if (const int error = plan.start(program, command, child, environment_of_trial())) {
    return refuse(fmt::format("cannot start {} to try it: {}", program, std::strerror(error)));
  }
  const auto status = ending_of(child, limit);
  if (!status) {
    return refuse(
        fmt::format("it is not loaded after {:g} s", std::chrono::duration<double>{limit}.count()));
  }
  if (WIFSIGNALED(*status)) {
    return refuse(fmt::format("it crashes when it is loaded ({})", strsignal(WTERMSIG(*status))));
  }
  if (WEXITSTATUS(*status) != kPluginTried) {
    return refuse(
        fmt::format("it ends the process when it is loaded (exit code {})", WEXITSTATUS(*status)));
  }
  for (const auto& file : files) tried().add(file);
  return {};
}

}  // namespace

Expected<void> try_plugin(const std::filesystem::path& file, std::chrono::milliseconds limit) {
  if (tried().has(file)) return {};
  return load_elsewhere({file}, limit);
}

void try_plugins(const std::vector<std::filesystem::path>& files) {
  // Enough for all that are sound; one that hangs has the time of a trial of its own later.
  constexpr std::chrono::seconds kTogether{2};
  std::vector<std::filesystem::path> untried;
  for (const auto& file : files) {
    if (!tried().has(file)) untried.push_back(file);
  }
  if (untried.size() > 1) static_cast<void>(load_elsewhere(untried, kTogether));
}

}  // namespace armature
