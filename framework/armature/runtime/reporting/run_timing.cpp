// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/reporting/run_timing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "armature/runtime/deployment/deployment.hpp"
#include "armature/values/json_text.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const TimingFigures& figures) {
  return {{"count", figures.count}, {"last_s", figures.last_s}, {"mean_s", figures.mean_s},
          {"p99_s", figures.p99_s}, {"p999_s", figures.p999_s}, {"max_s", figures.max_s}};
}

TimingFigures figures_from(const Json& json) {
  return {.count = json.at("count"),
          .last_s = json.at("last_s"),
          .mean_s = json.at("mean_s"),
          .p99_s = json.at("p99_s"),
          .p999_s = json.at("p999_s"),
          .max_s = json.at("max_s")};
}

Json to_json(const RunTiming::Executor& executor) {
  return {{"lateness", to_json(executor.lateness)}, {"cycle", to_json(executor.cycle)}};
}

Json to_json(const RunTiming::Component& component) {
  return {{"lateness", to_json(component.lateness)},
          {"step", to_json(component.step)},
          {"processor", to_json(component.processor)}};
}

template <class Entry>
std::string own_name(const std::vector<Entry>& entries, const std::string& name,
                     const std::string& process) {
  const bool taken = std::ranges::find(entries, name, &Entry::name) != entries.end();
  return taken ? fmt::format("{}@{}", name, process) : name;
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
  for (const auto& runner : deployment.runners()) {
    timing.components.push_back({.name = runner->name(),
                                 .lateness = figures(runner->times().lateness),
                                 .step = figures(runner->times().duration),
                                 .processor = figures(runner->times().processor)});
    const CycleTimes* executor = runner->executor_times();
    if (!executor || !told.insert(executor).second) continue;
    timing.executors.push_back({.name = *runner->executor_name(),
                                .lateness = figures(executor->lateness),
                                .cycle = figures(executor->duration)});
  }
  return timing;
}

Json to_json(const RunTiming& timing) {
  Json json{{"executors", Json::object()}, {"components", Json::object()}};
  for (const auto& executor : timing.executors) {
    json["executors"][executor.name] = to_json(executor);
  }
  for (const auto& component : timing.components) {
    json["components"][component.name] = to_json(component);
  }
  return json;
}

std::vector<std::string> to_lines(const RunTiming& timing) {
  std::vector<std::string> lines;
  for (const auto& executor : timing.executors) {
    lines.push_back(json_text(Json{{"executor", executor.name}, {"times", to_json(executor)}}));
  }
  for (const auto& component : timing.components) {
    lines.push_back(json_text(Json{{"component", component.name}, {"times", to_json(component)}}));
  }
  return lines;
}

void add_line(RunTiming& timing, const std::string& process, std::string_view line) {
  const Json told = Json::parse(line);
  const Json& times = told.at("times");
  const auto figures = [&](const char* what) { return figures_from(times.at(what)); };
  if (told.contains("executor")) {
    timing.executors.push_back({.name = own_name(timing.executors, told.at("executor"), process),
                                .lateness = figures("lateness"),
                                .cycle = figures("cycle")});
  } else {
    timing.components.push_back({.name = own_name(timing.components, told.at("component"), process),
                                 .lateness = figures("lateness"),
                                 .step = figures("step"),
                                 .processor = figures("processor")});
  }
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
