// SPDX-License-Identifier: Apache-2.0
// Loads libraries, for a process that wants to know what comes of it:
//   load_plugin PROCESS LIBRARY...
#include <dlfcn.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <string>

#include "armature/runtime/plugins/plugin_trial.hpp"

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (std::to_string(getppid()) != argv[1]) return 1;  // it ended before that line
  std::signal(SIGINT, SIG_IGN);  // an interrupted program has its own to say, and ends this one
  // A library that cannot be loaded is no news: the other process gets the reason itself.
  for (int i = 2; i < argc; ++i) dlopen(argv[i], RTLD_NOW | RTLD_LOCAL);
  _exit(armature::kPluginTried);
}
