// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "armature/runtime/timing_histogram.hpp"

namespace armature {

class Deployment;

/// How late and how long the executors and the components of a process were, from the start of a
/// run to its end.
struct RunTiming {
  struct Executor {
    std::string name;
    TimingFigures lateness, cycle;
  };
  struct Component {
    std::string name;
    TimingFigures lateness, step, processor;
  };
  std::vector<Executor> executors;  // none in lockstep
  std::vector<Component> components;
};
RunTiming timing_of(const Deployment& deployment);

/// `{"executors": {"control": {"lateness": {"count": ..., "mean_s": ...}, ...}}, "components":
/// ...}`
nlohmann::ordered_json to_json(const RunTiming& timing);
/// For people, in microseconds.
std::string to_table(const RunTiming& timing);

}  // namespace armature
