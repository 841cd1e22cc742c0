// SPDX-License-Identifier: Apache-2.0
#include "loop_bench/readers.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>
#include <system_error>
#include <vector>

#include "armature/values/spawn_plan.hpp"

namespace armature::bench {

Readers::Readers(int count, int domain) {
  SpawnPlan plan;
  plan.give_nothing(STDOUT_FILENO).give_nothing(STDERR_FILENO);
  const std::vector<std::string> words{
      "armature", "topic", "hz", "/bench_loop/joint_state", "--domain", std::to_string(domain)};
  int error = 0;
  for (int i = 0; i < count && error == 0; ++i) {
    pid_t process = 0;
    error = plan.start("/proc/self/exe", words, process);
    if (error == 0) processes_.push_back(process);
  }
  if (error != 0) throw std::system_error(error, std::generic_category(), "cannot start a reader");
}

Readers::~Readers() {
  for (const pid_t process : processes_) kill(process, SIGKILL);
  for (const pid_t process : processes_) waitpid(process, nullptr, 0);
}

}  // namespace armature::bench
