// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>
#include <string_view>
#include <vector>

#include "armature/runtime/processes/control_channel.hpp"

namespace armature ARMATURE_EXPORT {

/// The option by which a process is told the descriptor of its control channel.
inline constexpr std::string_view kControlOption = "--control";

/// This executable, run once more, and the way to it.
struct StartedProcess {
  pid_t pid;
  SocketChannel control;
};

/// Starts it with `arguments` and the control option, in a process group of its own. Throws
/// std::system_error, which calls it `name`.
StartedProcess start_process(const std::string& name, std::vector<std::string> arguments);

/// "was killed by signal 9 (Killed)", "ended with exit code 1"; `status` as of waitpid().
std::string text_of_status(int status);

}  // namespace armature
