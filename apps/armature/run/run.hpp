// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "armature/values/time.hpp"

namespace armature {

/// A deployment as named on the command line: files, overlays and assignments.
struct DeploymentSource {
  std::vector<std::filesystem::path> files;
  std::vector<std::string> assignments;  // --set
};

struct RunOptions {
  DeploymentSource source;
  std::optional<int> domain;  // instead of the file's
  std::string process;  // only this one of the deployment; empty: main, and it starts the rest
  std::string host = "main";  // whose processes
  /// What the main process hands to the others that it starts.
  struct Origin {
    Duration clock_offset;  // of its SystemClock
    Time start;             // which the operator's lines count from
    std::string run = {};   // the name of the run; "" of a process that is started by hand
  };
  std::optional<Origin> origin;  // none: this process' own
  int control = -1;              // descriptor of the way to the main process, if that started it
  bool json = false;
  bool timing = false;        // tells how late and how long the steps were
  bool keep_running = false;  // when the scenario is over, until Ctrl-C
  std::optional<std::filesystem::path> report;
  std::filesystem::path report_files;  // of another process: the folder of the main one's report
  bool records_for_page = false;      // into the report's folder, as the deployment records nothing
  std::optional<std::string> inject;  // a drill's fault, "motion:throw", struck at SIGUSR1
};

/// `armature run`: exit code 0 only when the deployment's goals are met.
int run_deployment(const RunOptions& options);

}  // namespace armature
