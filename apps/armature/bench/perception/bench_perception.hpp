// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "bench/perception/chosen_perception.hpp"
#include "run/run.hpp"

namespace armature {

struct PerceptionBenchOptions {
  DeploymentSource source;
  bench::PerceptionChoice choice;
  int pairs = 300;
  std::uint64_t seed = 1;
  std::string group;                 // only groups with this in their name
  std::optional<std::string> csv;    // file: one line per pair
  std::optional<std::string> worst;  // folder: pictures of the worst pairs
  bool json = false;
};

/// `armature bench perception`: detector, landmark finder and face pose estimator of a deployment
/// on drawn stereo pairs whose truth is known.
int bench_perception(const PerceptionBenchOptions& options);

}  // namespace armature
