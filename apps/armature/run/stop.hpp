// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/bus/network.hpp"

namespace armature {

struct StopOptions {
  NetworkOptions network;
  double timeout_s = 3;  // for a deployment to be found, and to take it
};

/// `armature stop`: every arm of the domain stops and stays stopped, whoever runs it. Exit code 0
/// when every deployment that was found has taken it, 5 when there was none or one did not.
int stop_arms(const StopOptions& options);

}  // namespace armature
