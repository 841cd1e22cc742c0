// SPDX-License-Identifier: Apache-2.0
#include "loop_bench/readers.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <string>
#include <system_error>

namespace armature::bench {

Readers::Readers(int count, int domain) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  for (const int file : {STDOUT_FILENO, STDERR_FILENO}) {
    posix_spawn_file_actions_addopen(&files, file, "/dev/null", O_WRONLY, 0);
  }
  std::string program = "/proc/self/exe", number = std::to_string(domain);
  std::array<std::string, 6> words{"armature", "topic", "hz", "/bench_loop/joint_state",
                                   "--domain", number};
  std::array<char*, 7> arguments{};
  for (std::size_t i = 0; i < words.size(); ++i) arguments[i] = words[i].data();
  int error = 0;
  for (int i = 0; i < count && error == 0; ++i) {
    pid_t process = 0;
    error = posix_spawn(&process, program.c_str(), &files, nullptr, arguments.data(), environ);
    if (error == 0) processes_.push_back(process);
  }
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) throw std::system_error(error, std::generic_category(), "cannot start a reader");
}

Readers::~Readers() {
  for (const pid_t process : processes_) kill(process, SIGKILL);
  for (const pid_t process : processes_) waitpid(process, nullptr, 0);
}

}  // namespace armature::bench
