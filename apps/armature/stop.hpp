// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace armature {

struct StopOptions {
  int domain = 0;
  double timeout_s = 3;  // for somebody to be found who can be stopped
};

/// `armature stop`: every arm of the domain stops and stays stopped, whoever runs it. Exit code 0
/// when somebody heard it, 5 when nobody was there.
int stop_arms(const StopOptions& options);

}  // namespace armature
