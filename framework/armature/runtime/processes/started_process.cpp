// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/processes/started_process.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <system_error>
#include <utility>

#include "armature/values/spawn_plan.hpp"

namespace armature {

StartedProcess start_process(const std::string& name, std::vector<std::string> arguments) {
  constexpr int kControlFile = STDERR_FILENO + 1;
  auto [ours, theirs] = SocketChannel::make();
  const std::string program = "/proc/self/exe";
  arguments.insert(arguments.begin(), program);
  arguments.insert(arguments.end(), {std::string{kControlOption}, std::to_string(kControlFile)});
  // Ctrl-C reaches whoever starts it, who ends it in order. Not fork: afterwards a thread of this
  // process would pay for every page that it touches. Fast DDS leaves its locks open to a program
  // that is started, which would hold them on.
  SpawnPlan plan;
  plan.hand_over(theirs.file(), kControlFile)
      .close_from(kControlFile + 1)
      .own_group()
      .unblock_signals();
  pid_t pid = 0;
  if (const int error = plan.start(program, arguments, pid)) {
    throw std::system_error(error, std::generic_category(), "cannot start " + name);
  }
  return {.pid = pid, .control = std::move(ours)};
}

std::string text_of_status(int status) {
  if (WIFSIGNALED(status)) {
    return fmt::format("was killed by signal {} ({})", WTERMSIG(status),
                       strsignal(WTERMSIG(status)));
  }
  return fmt::format("ended with exit code {}", WEXITSTATUS(status));
}

}  // namespace armature
