// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugins/plugin_trial.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
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

}  // namespace

Expected<void> try_plugin(const std::filesystem::path& file, std::chrono::milliseconds limit) {
  const std::string program = library_folder() / "armature" / "load_plugin";
  SpawnPlan plan;
  plan.give_nothing(STDIN_FILENO).give_nothing(STDOUT_FILENO).give_nothing(STDERR_FILENO);
  plan.own_group().unblock_signals().default_signals();
  pid_t child = -1;
  if (const int error = plan.start(program, {program, std::to_string(getpid()), file.string()},
                                   child, environment_of_trial())) {
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
  return {};
}

}  // namespace armature
