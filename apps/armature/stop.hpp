// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace armature {

struct StopOptions {
  int domain = 0;
  std::vector<std::string> interfaces;  // joined beside loopback
  double timeout_s = 3;                 // for somebody to be found who can be stopped
};

/// `armature stop`: every arm of the domain stops and stays stopped, whoever runs it. Exit code 0
/// when somebody heard it, 5 when nobody was there.
int stop_arms(const StopOptions& options);

}  // namespace armature
