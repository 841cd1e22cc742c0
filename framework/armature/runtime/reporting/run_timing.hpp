// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "armature/runtime/execution/timing_histogram.hpp"

namespace armature ARMATURE_EXPORT {

class Deployment;

/// How late and how long the executors and the components of a run were, from its start to its end.
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
/// Of this process.
RunTiming timing_of(const Deployment& deployment);

/// A line of JSON for every executor and component: how one process of a deployment tells another.
std::vector<std::string> to_lines(const RunTiming& timing);
/// Adds such a line of `process`. What has a name that is there already is called `control@aside`.
/// Throws nlohmann::json::exception for what is no such line.
void add_line(RunTiming& timing, const std::string& process, std::string_view line);

/// `{"executors": {"control": {"lateness": {"count": ..., "mean_s": ...}, ...}}, "components":
/// ...}`
nlohmann::ordered_json to_json(const RunTiming& timing);
/// For people, in microseconds.
std::string to_table(const RunTiming& timing);

}  // namespace armature
