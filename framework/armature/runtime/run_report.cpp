// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/run_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

namespace armature {

RunReport::RunReport(const Deployment& deployment, const Ending& ending) {
  for (const auto& unit : deployment.units()) {
    speaker_ = &deployment.config_of(*unit);
    unit->component().summarize(*this);
  }
  judge(deployment, ending);
}

void RunReport::metric(std::string key, std::string title, double value) {
  const auto& declared = speaker_->manifest->measures;
  if (std::ranges::find(declared, key, &MetricSpec::name) == declared.end()) {
    defect_ = fmt::format(
        "{}: plugin '{}' reports the metric '{}', which its plugin.yaml does not "
        "declare under 'measures:'",
        speaker_->name, speaker_->manifest->id, key);
  }
  figures_.push_back({std::move(key), std::move(title), value});
}
void RunReport::text(std::string key, std::string title, std::string value) {
  figures_.push_back({std::move(key), std::move(title), std::move(value)});
}
void RunReport::failed(std::string status) { story_status_ = std::move(status); }

void RunReport::judge(const Deployment& deployment, const Ending& ending) {
  for (const Goal& goal : deployment.config().goals) {
    bool found = false;
    for (Figure& figure : figures_) {
      const double* value = std::get_if<double>(&figure.value);
      if (figure.key != goal.metric || !value) continue;
      found = true;
      figure.goal = &goal;
      figure.met = *value <= goal.limit;  // false for NaN: nothing was measured
      if (!figure.met) {
        reasons_.push_back(std::isnan(*value)
                               ? fmt::format("{} was never measured", goal.metric)
                               : fmt::format("{} is {:.3f}, the goal is at most {:g}", goal.metric,
                                             *value, goal.limit));
      }
    }
    if (!found) reasons_.push_back(fmt::format("{} was never measured", goal.metric));
  }
  if (deployment.timed_out() && !deployment.config().goals.empty()) {
    reasons_.push_back(fmt::format("the time limit of {:g} s was over before the end of the story",
                                   deployment.config().time_limit_s));
  }
  // A deployment with goals tells a story, and this one was not heard to its end.
  if (ending.stopped && !deployment.config().goals.empty()) {
    reasons_.push_back(*ending.stopped + " before the end of the story");
  }
  if (!reasons_.empty()) status_ = "goals_missed";
  if (!story_status_.empty()) status_ = story_status_;
  if (const std::string fault = deployment.fault(); !fault.empty()) {
    status_ = "fault";
    reasons_.insert(reasons_.begin(), fault);
  }
  if (!defect_.empty()) {
    status_ = "fault";
    reasons_.insert(reasons_.begin(), defect_);
  }
  if (ending.lost_process) {
    status_ = "fault";
    reasons_.insert(reasons_.begin(), *ending.lost_process);
  }
}

std::string to_json(const RunReport& report) {
  nlohmann::ordered_json json;
  json["status"] = report.status();
  for (const auto& figure : report.figures()) {
    if (const double* value = std::get_if<double>(&figure.value)) {
      json[figure.key] = std::isfinite(*value) ? nlohmann::ordered_json(*value) : nullptr;
    } else {
      json[figure.key] = std::get<std::string>(figure.value);
    }
  }
  if (!report.reasons().empty()) json["reasons"] = report.reasons();
  return json.dump();
}

namespace {

/// Counts without decimals, measures with three, or where these would all be 0 by their power of
/// ten; nothing measured is a dash.
std::string number_text(double value) {
  constexpr double kShownAsZero = 0.0005;
  if (std::isnan(value)) return "         -";
  if (value != 0 && std::abs(value) < kShownAsZero) return fmt::format("{:10.0e}", value);
  return value == std::floor(value) ? fmt::format("{:10.0f}", value)
                                    : fmt::format("{:10.3f}", value);
}

}  // namespace

std::string to_table(const RunReport& report) {
  std::size_t width = 0;
  for (const auto& figure : report.figures()) width = std::max(width, figure.title.size());
  std::string table;
  for (const auto& figure : report.figures()) {
    const double* value = std::get_if<double>(&figure.value);
    std::string shown = value ? number_text(*value) : std::get<std::string>(figure.value);
    table += fmt::format("  {:<{}}  {}", figure.title, width, shown);
    if (figure.goal) {
      table += fmt::format("   goal {:g}  {}", figure.goal->limit, figure.met ? "met" : "MISSED");
    }
    table += '\n';
  }
  table += fmt::format("  {:<{}}  {}\n", "status", width, report.status());
  for (const auto& reason : report.reasons()) table += fmt::format("    {}\n", reason);
  return table;
}

void write_report(const RunReport& report, const Deployment& deployment,
                  const std::filesystem::path& directory) {
  std::filesystem::create_directories(directory);
  for (const auto& unit : deployment.units()) unit->component().write_files(directory);
  const auto file = directory / "report.json";
  std::ofstream stream{file};
  stream << to_json(report) << '\n';
  stream.close();
  if (!stream) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace armature
