// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

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
  bool json = false;
  std::optional<std::filesystem::path> report;
};

/// `armature run`: exit code 0 only when the deployment's goals are met.
int run_deployment(const RunOptions& options);

}  // namespace armature
