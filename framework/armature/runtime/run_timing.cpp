// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/run_timing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "armature/runtime/deployment.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const TimingFigures& figures) {
  return {{"count", figures.count}, {"last_s", figures.last_s}, {"mean_s", figures.mean_s},
          {"p99_s", figures.p99_s}, {"p999_s", figures.p999_s}, {"max_s", figures.max_s}};
}

std::string columns(const TimingFigures& figures) {
  return fmt::format(" {:>10.1f} {:>9.1f} {:>9.1f} {:>9.1f}", 1e6 * figures.mean_s,
                     1e6 * figures.p99_s, 1e6 * figures.p999_s, 1e6 * figures.max_s);
}

std::string header(std::string_view what) {
  return fmt::format(" {:>10} {:>9} {:>9} {:>9}", fmt::format("{} mean", what), "p99", "p99.9",
                     "max");
}

}  // namespace

RunTiming timing_of(const Deployment& deployment) {
  const auto figures = [](const TimingHistogram& histogram) {
    return histogram.counts().figures();
  };
  RunTiming timing;
  std::set<const CycleTimes*> told;
  for (const auto& unit : deployment.units()) {
    timing.components.push_back({.name = unit->name(),
                                 .lateness = figures(unit->times().lateness),
                                 .step = figures(unit->times().duration),
                                 .processor = figures(unit->times().processor)});
    const CycleTimes* executor = unit->executor_times();
    if (!executor || !told.insert(executor).second) continue;
    timing.executors.push_back({.name = *unit->executor_name(),
                                .lateness = figures(executor->lateness),
                                .cycle = figures(executor->duration)});
  }
  return timing;
}

Json to_json(const RunTiming& timing) {
  Json json{{"executors", Json::object()}, {"components", Json::object()}};
  for (const auto& [name, lateness, cycle] : timing.executors) {
    json["executors"][name] = {{"lateness", to_json(lateness)}, {"cycle", to_json(cycle)}};
  }
  for (const auto& [name, lateness, step, processor] : timing.components) {
    json["components"][name] = {{"lateness", to_json(lateness)},
                                {"step", to_json(step)},
                                {"processor", to_json(processor)}};
  }
  return json;
}

std::string to_table(const RunTiming& timing) {
  std::size_t width = std::string_view{"component [us]"}.size();
  for (const auto& executor : timing.executors) width = std::max(width, executor.name.size());
  for (const auto& component : timing.components) width = std::max(width, component.name.size());
  std::string text;
  if (!timing.executors.empty()) {
    text += fmt::format("  {:<{}} {:>9}{}{}\n", "executor [us]", width, "cycles", header("late"),
                        header("cycle"));
  }
  for (const auto& [name, lateness, cycle] : timing.executors) {
    text += fmt::format("  {:<{}} {:>9}{}{}\n", name, width, cycle.count, columns(lateness),
                        columns(cycle));
  }
  text += fmt::format("  {:<{}} {:>9}{}{}{}\n", "component [us]", width, "steps", header("late"),
                      header("step"), header("cpu"));
  for (const auto& [name, lateness, step, processor] : timing.components) {
    text += fmt::format("  {:<{}} {:>9}{}{}{}\n", name, width, step.count, columns(lateness),
                        columns(step), columns(processor));
  }
  return text;
}

}  // namespace armature
