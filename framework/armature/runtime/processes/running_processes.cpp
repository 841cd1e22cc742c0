// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/processes/running_processes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/runtime/processes/instance_lock.hpp"

namespace armature {
namespace {

constexpr std::string_view kBeginning = "deployment ";

/// The state stands behind the program's name, which may have any sign in it: "12 (a) b) T 1 ..".
bool is_halted(pid_t pid) {
  std::ifstream file{fmt::format("/proc/{}/stat", pid)};
  std::string line;
  std::getline(file, line);
  const std::size_t name_end = line.rfind(") ");
  if (name_end == std::string::npos) return false;
  const char state = line[name_end + 2];
  return state == 'T' || state == 't';
}

bool is_printable(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c >= 0x20 && c < 0x7F; });
}

}  // namespace

std::string lock_of_process(std::string_view deployment, int domain, std::string_view process) {
  return fmt::format("{}{} domain {} process {}", kBeginning, deployment, domain, process);
}

std::string RunningProcess::text() const {
  const std::string of_process =
      process == kMainProcess ? "" : fmt::format("process '{}' of ", process);
  return fmt::format("{}deployment '{}' ({})", of_process, deployment,
                     pid > 0 ? fmt::format("pid {}", pid) : "asked for too often to tell its pid");
}

std::vector<RunningProcess> running_processes(int domain) {
  const std::string between = fmt::format(" domain {} process ", domain);
  std::vector<RunningProcess> running;
  for (const auto& [lock, holder] : InstanceLock::held(std::string{kBeginning})) {
    const std::string name = lock.substr(kBeginning.size());
    const std::size_t place = name.find(between);
    if (place == std::string::npos || !is_printable(name)) continue;
    running.push_back({.deployment = name.substr(0, place),
                       .process = name.substr(place + between.size()),
                       .pid = holder,
                       .halted = is_halted(holder)});
  }
  return running;
}

}  // namespace armature
