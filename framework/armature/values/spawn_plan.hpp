// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sched.h>
#include <spawn.h>
#include <sys/types.h>
#include <unistd.h>

#include <csignal>
#include <string>
#include <vector>

namespace armature ARMATURE_EXPORT {

/// How a program is started: which files it gets, and how free it is of its starter. It inherits
/// whatever the plan does not change.
class SpawnPlan {
 public:
  SpawnPlan() {
    posix_spawn_file_actions_init(&files_);
    posix_spawnattr_init(&attributes_);
  }
  ~SpawnPlan() {
    posix_spawnattr_destroy(&attributes_);
    posix_spawn_file_actions_destroy(&files_);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;

  /// Our descriptor `file` is `as` in the program.
  SpawnPlan& hand_over(int file, int as) {
    posix_spawn_file_actions_adddup2(&files_, file, as);
    return *this;
  }
  /// Nothing can be read from `file`, and what is written there is gone.
  SpawnPlan& give_nothing(int file) {
    posix_spawn_file_actions_addopen(&files_, file, "/dev/null", O_RDWR, 0);
    return *this;
  }
  /// The program gets none of our descriptors from `first` on.
  SpawnPlan& close_from(int first) {
    posix_spawn_file_actions_addclosefrom_np(&files_, first);
    return *this;
  }
  SpawnPlan& in_folder(const std::string& folder) {
    posix_spawn_file_actions_addchdir_np(&files_, folder.c_str());
    return *this;
  }
  /// A process group of its own, which Ctrl-C does not reach.
  SpawnPlan& own_group() {
    posix_spawnattr_setpgroup(&attributes_, 0);
    return set(POSIX_SPAWN_SETPGROUP);
  }
  /// No signal is blocked.
  SpawnPlan& unblock_signals() {
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes_, &none);
    return set(POSIX_SPAWN_SETSIGMASK);
  }
  /// No signal is ignored.
  SpawnPlan& default_signals() {
    sigset_t all;
    sigfillset(&all);
    posix_spawnattr_setsigdefault(&attributes_, &all);
    return set(POSIX_SPAWN_SETSIGDEF);
  }
  /// No real-time priority, although the thread that starts it has one.
  SpawnPlan& normal_priority() {
    const sched_param normal{};
    posix_spawnattr_setschedpolicy(&attributes_, SCHED_OTHER);
    posix_spawnattr_setschedparam(&attributes_, &normal);
    return set(POSIX_SPAWN_SETSCHEDULER);
  }

  /// Starts the file `program` with `words`, the first of which is its name there, and with our
  /// environment or the one given ("NAME=value"). Returns 0, or the error's number.
  int start(const std::string& program, std::vector<std::string> words, pid_t& pid) const {
    return posix_spawn(&pid, program.c_str(), &files_, &attributes_, pointers_to(words).data(),
                       environ);
  }
  int start(const std::string& program, std::vector<std::string> words, pid_t& pid,
            std::vector<std::string> environment) const {
    return posix_spawn(&pid, program.c_str(), &files_, &attributes_, pointers_to(words).data(),
                       pointers_to(environment).data());
  }

 private:
  static std::vector<char*> pointers_to(std::vector<std::string>& texts) {
    std::vector<char*> pointers;
    for (std::string& text : texts) pointers.push_back(text.data());
    pointers.push_back(nullptr);
    return pointers;
  }
  SpawnPlan& set(short flag) {
    short flags = 0;
    posix_spawnattr_getflags(&attributes_, &flags);
    posix_spawnattr_setflags(&attributes_, static_cast<short>(flags | flag));
    return *this;
  }

  posix_spawn_file_actions_t files_;
  posix_spawnattr_t attributes_;
};

}  // namespace armature
