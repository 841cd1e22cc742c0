// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "run/run.hpp"

namespace armature {

struct WatchedBenchOptions {
  DeploymentSource source;
  int readers = 4;
  int rounds = 5;
  double seconds = 10;  // of a run
  int domain = 102;     // DDS
  bool json = false;
};

/// `armature bench watched`: what it costs a deployment's own threads that it is recorded, and that
/// others read its topics, beside the same deployment alone. Exit code 1 when a goal is missed.
int bench_watched(const WatchedBenchOptions& options);

}  // namespace armature
