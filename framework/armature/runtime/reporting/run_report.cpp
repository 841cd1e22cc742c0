// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/reporting/run_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "armature/runtime/plugins/running_component.hpp"
#include "armature/runtime/plugins/setup_error.hpp"
#include "armature/runtime/reporting/output_folder.hpp"
#include "armature/runtime/reporting/write_atomically.hpp"
#include "armature/values/json_text.hpp"

namespace armature {

RunReport::RunReport(const Deployment& deployment, const Ending& ending) {
  for (const auto& runner : deployment.runners()) {
    if (deployment.is_hung(*runner)) continue;
    speaker_ = &deployment.config_of(*runner);
    deployment.tell_ending("summary", *runner);
    const std::size_t told = figures_.size();
    runner->summarize(*this);
    for (std::size_t i = told; i < figures_.size(); ++i) {
      figures_[i].component = runner->name();
      figures_[i].metric = figures_[i].key;
    }
  }
  tell_apart();
  unwell_ = deployment.unwell();
  unwell_.insert(unwell_.end(), ending.unwell.begin(), ending.unwell.end());
  if (story_status_.empty() && ending.failed) failed(ending.failed->first, ending.failed->second);
  judge(deployment, ending);
  timing_ = ending.timing;
}

const MetricSpec* RunReport::expect_declared(const std::string& key) {
  const auto& declared = speaker_->manifest->measures;
  const auto found = std::ranges::find(declared, key, &MetricSpec::name);
  if (found != declared.end()) return &*found;
  add_defect(key, "which its plugin.yaml does not declare under 'measures:'");
  return nullptr;
}

void RunReport::add_defect(const std::string& key, const std::string& what) {
  defects_.push_back(fmt::format("{}: plugin '{}' reports the metric '{}', {}", speaker_->name,
                                 speaker_->manifest->id, key, what));
}

void RunReport::metric(std::string key, std::string title, double value) {
  const MetricSpec* declared = expect_declared(key);
  if (!std::isfinite(value)) {
    add_defect(key,
               "which is not finite; what was not measured is told with its reason, by "
               "Summary::not_measured()");
  } else if (value < 0 && declared && !declared->may_be_negative) {
    add_defect(key,
               fmt::format("which is {:g}, and its plugin.yaml does not say that it may be below 0 "
                           "(signed: true): every goal would be met",
                           value));
  }
  figures_.push_back({std::move(key), std::move(title), value});
}
void RunReport::series(std::string key, std::string title, std::vector<double> values) {
  figures_.push_back({std::move(key), std::move(title), std::move(values)});
}
void RunReport::text(std::string key, std::string title, std::string value) {
  figures_.push_back({std::move(key), std::move(title), std::move(value)});
}
void RunReport::not_measured(std::string key, std::string title, std::string why) {
  expect_declared(key);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  figures_.push_back({std::move(key), std::move(title), kNone, std::move(why)});
}
void RunReport::does_not_apply(std::string key, std::string title, std::string why) {
  expect_declared(key);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  figures_.push_back({.key = std::move(key),
                      .title = std::move(title),
                      .value = kNone,
                      .inapplicable = std::move(why)});
}
void RunReport::failed(std::string status, std::string reason) {
  story_status_ = status.empty() || status == "ok" ? "failed" : std::move(status);
  story_reason_ = std::move(reason);
}

void RunReport::tell_apart() {
  for (Figure& figure : figures_) {
    const bool is_told_twice = std::ranges::any_of(figures_, [&](const Figure& other) {
      return other.metric == figure.metric && other.component != figure.component;
    });
    if (!is_told_twice) continue;
    figure.key = figure.component + "." + figure.metric;
    figure.title = figure.component + ": " + figure.title;
  }
}

void RunReport::judge_goal(const Goal& goal) {
  bool found = false;
  for (Figure& figure : figures_) {
    const double* value = std::get_if<double>(&figure.value);
    if (figure.metric != goal.metric || !value) continue;
    found = true;
    figure.goal = &goal;
    if (!figure.inapplicable.empty()) continue;
    figure.met = *value <= goal.limit;  // false for NaN
    if (figure.met) continue;
    if (!figure.unmeasured.empty()) {
      reasons_.push_back(fmt::format("{} was not measured: {}", figure.key, figure.unmeasured));
    } else if (!std::isfinite(*value)) {
      reasons_.push_back(fmt::format("{} is not finite", figure.key));
    } else {
      reasons_.push_back(
          fmt::format("{} is {:.3f}, the goal is at most {:g}", figure.key, *value, goal.limit));
    }
  }
  if (!found) reasons_.push_back(fmt::format("{} was never measured", goal.metric));
}

namespace {

/// What did not come to rest, or not back at all, when the run was over.
std::vector<std::string> faults_of_the_end(const Deployment& deployment) {
  std::vector<std::string> faults;
  for (const std::string& name : deployment.moving()) {
    faults.push_back(fmt::format("'{}' was not at rest {:g} s after it was to stop", name,
                                 deployment.config().stop_within_s));
  }
  std::ranges::copy(deployment.hangs(), std::back_inserter(faults));
  return faults;
}

}  // namespace

void RunReport::judge(const Deployment& deployment, const Ending& ending) {
  for (const Goal& goal : deployment.config().goals) judge_goal(goal);
  if (deployment.timed_out()) {
    ended_by_ = fmt::format("the time limit of {:g} s is over", deployment.config().time_limit_s);
  } else if (ending.stopped) {
    ended_by_ = *ending.stopped;
  }
  if (deployment.timed_out() && !deployment.config().goals.empty()) {
    reasons_.insert(reasons_.begin(),
                    fmt::format("the time limit of {:g} s was over before the end of the scenario",
                                deployment.config().time_limit_s));
  }
  // A deployment with goals tells a scenario, and this one was not heard to its end.
  if (ending.stopped && !deployment.config().goals.empty()) {
    reasons_.insert(reasons_.begin(), *ending.stopped + " before the end of the scenario");
  }
  if (!reasons_.empty()) status_ = "goals_missed";
  // Without goals nothing else says whether the run did what it is for.
  if (deployment.config().goals.empty() && !deployment.scenario_over() && !unwell_.empty()) {
    status_ = "degraded";
  }
  if (!story_status_.empty()) status_ = story_status_;
  std::vector<std::string> faults = ending.faults;
  std::ranges::copy(defects_, std::back_inserter(faults));
  if (std::string fault = deployment.fault(); !fault.empty()) faults.push_back(std::move(fault));
  std::ranges::move(deployment.isolated_faults(), std::back_inserter(faults));
  std::ranges::move(deployment.silent(), std::back_inserter(faults));
  std::ranges::move(faults_of_the_end(deployment), std::back_inserter(faults));
  if (!faults.empty()) status_ = "fault";
  reasons_.insert(reasons_.begin(), faults.begin(), faults.end());
}

namespace {

using Json = nlohmann::ordered_json;

Json to_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json to_json(const std::string& value) { return value; }
Json to_json(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(to_json(value));
  return list;
}

/// Counts without decimals, measures with three, or where these would all be 0 by their power of
/// ten; nothing measured is a dash.
std::string shown(double value) {
  constexpr double kShownAsZero = 0.0005;
  if (std::isnan(value)) return "         -";
  if (value != 0 && std::abs(value) < kShownAsZero) return fmt::format("{:10.0e}", value);
  return value == std::floor(value) ? fmt::format("{:10.0f}", value)
                                    : fmt::format("{:10.3f}", value);
}
std::string shown(const std::string& value) { return value; }
std::string shown(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) {
    const std::string number = shown(value);
    text += (text.empty() ? "" : ", ") + number.substr(number.find_first_not_of(' '));
  }
  return text;
}

/// Of a run that is not ok, in one place, whatever ended it.
std::string first_reason(const RunReport& report) {
  if (!report.story_reason().empty()) return report.story_reason();
  if (!report.reasons().empty()) return report.reasons().front();
  return report.status() == "degraded" ? report.unwell().front() : "";
}

}  // namespace

std::string to_json(const RunReport& report) {
  Json json, unmeasured, inapplicable;
  json["status"] = report.status();
  if (const std::string reason = first_reason(report); !reason.empty()) json["reason"] = reason;
  for (const auto& figure : report.figures()) {
    json[figure.key] = std::visit([](const auto& value) { return to_json(value); }, figure.value);
    if (!figure.unmeasured.empty()) unmeasured[figure.key] = figure.unmeasured;
    if (!figure.inapplicable.empty()) inapplicable[figure.key] = figure.inapplicable;
  }
  if (!unmeasured.empty()) json["not_measured"] = unmeasured;
  if (!inapplicable.empty()) json["does_not_apply"] = inapplicable;
  if (!report.reasons().empty()) json["reasons"] = report.reasons();
  if (!report.unwell().empty()) json["unwell"] = report.unwell();
  if (!report.ended_by().empty()) json["ended_by"] = report.ended_by();
  if (report.timing()) json["timing"] = to_json(*report.timing());
  return json_text(json);
}

std::string figures_json(const RunReport& report, const RunTiming& timing) {
  Json json{{"status", report.status()}, {"reasons", Json::array()}, {"figures", Json::array()}};
  if (!report.story_reason().empty()) json["reasons"].push_back(report.story_reason());
  for (const std::string& reason : report.reasons()) json["reasons"].push_back(reason);
  for (const std::string& unwell : report.unwell()) json["reasons"].push_back("unwell: " + unwell);
  for (const auto& figure : report.figures()) {
    Json& told = json["figures"].emplace_back();
    told = {{"key", figure.key},
            {"title", figure.title},
            {"value", std::visit([](const auto& value) { return to_json(value); }, figure.value)}};
    if (figure.goal) {
      told["goal"] = figure.goal->limit;
      if (figure.inapplicable.empty()) told["met"] = figure.met;
    }
    if (!figure.unmeasured.empty()) told["not_measured"] = figure.unmeasured;
    if (!figure.inapplicable.empty()) told["does_not_apply"] = figure.inapplicable;
  }
  json["timing"] = to_json(timing);
  return json_text(json);
}

std::string to_table(const RunReport& report, const Mark& mark, const Quote& quote) {
  std::size_t width = 0;
  for (const auto& figure : report.figures()) width = std::max(width, figure.title.size());
  std::string table;
  for (const auto& figure : report.figures()) {
    table += fmt::format("  {:<{}}  {}", figure.title, width,
                         std::visit([](const auto& value) { return shown(value); }, figure.value));
    if (figure.goal) {
      table += fmt::format("   goal {:g}", figure.goal->limit);
      if (figure.inapplicable.empty()) {
        table += "  " + mark(figure.met ? "met" : "MISSED", figure.met);
      }
    }
    if (!figure.unmeasured.empty()) table += "   not measured: " + quote(figure.unmeasured);
    if (!figure.inapplicable.empty()) table += "   does not apply: " + quote(figure.inapplicable);
    table += '\n';
  }
  table += fmt::format("  {:<{}}  {}\n", "status", width,
                       mark(report.status(), report.status() == "ok"));
  const auto tell = [&](std::string_view what, std::string_view text) {
    table += fmt::format("    {}{}\n", what, quote(text));
  };
  if (!report.ended_by().empty()) tell("ended by: ", report.ended_by());
  if (!report.story_reason().empty()) tell("", report.story_reason());
  for (const std::string& reason : report.reasons()) tell("", reason);
  for (const std::string& unwell : report.unwell()) tell("unwell: ", unwell);
  if (report.timing()) table += to_table(*report.timing());
  return table;
}

std::string write_component_files(const Deployment& deployment,
                                  const std::filesystem::path& directory) {
  std::string failed;
  for (const auto& runner : deployment.runners()) {
    if (deployment.is_hung(*runner)) continue;
    deployment.tell_ending("report", *runner);
    try {
      const RunningComponent running{runner->name(), "report"};
      runner->component().write_files(directory);
    } catch (...) {
      failed += fmt::format("{}component '{}': {}", failed.empty() ? "" : "; ", runner->name(),
                            current_exception_text());
    }
  }
  return failed;
}

void write_report(const RunReport& report, const Deployment& deployment,
                  const std::filesystem::path& directory) {
  prepare_output_folder(directory);
  std::string failed;
  try {
    write_atomically(directory / "report.json", to_json(report) + '\n');
  } catch (const std::runtime_error& error) {
    failed = error.what();
  }
  if (const std::string theirs = write_component_files(deployment, directory); !theirs.empty()) {
    failed += (failed.empty() ? "" : "; ") + theirs;
  }
  if (!failed.empty()) throw std::runtime_error{failed};
}

}  // namespace armature
