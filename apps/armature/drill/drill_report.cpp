// SPDX-License-Identifier: Apache-2.0
#include "drill/drill_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "armature/values/json_text.hpp"

namespace armature::drill {
namespace {

constexpr const char* kRow = "{:<18} {:<6} {:>7} {:>8} {:>9}  {:<9} {}";

std::string seconds_text(double value) { return fmt::format("{:.2f}", value); }

nlohmann::ordered_json number(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nullptr;
}

nlohmann::ordered_json text_or_null(const std::string& text) {
  return text.empty() ? nlohmann::ordered_json{} : nlohmann::ordered_json(text);
}

struct Counts {
  std::ptrdiff_t passed, failed, not_tried;
};

Counts count(const std::vector<TrialResult>& results) {
  const auto passed = std::ranges::count_if(results, &TrialResult::passed);
  const auto failed = std::ranges::count_if(results, &TrialResult::failed);
  return {passed, failed, std::ssize(results) - passed - failed};
}

const char* verdict(const TrialResult& result) {
  if (result.failed()) return "FAIL";
  return result.passed() ? "pass" : "not tried";
}

}  // namespace

std::string table_head() {
  return fmt::format(fmt::runtime(kRow), "fault", "form", "at [s]", "rest [s]", "step [us]",
                     "result", "what the arm did, and what was shown");
}

std::string table_row(const TrialResult& result) {
  std::string said = result.passed() || result.failed() ? result.arm : result.untried;
  if (!result.shown.empty()) said += fmt::format("\n{:>59} {}", "|", result.shown);
  return fmt::format(
      fmt::runtime(kRow), result.fault, to_string(result.form), seconds_text(result.moment_s),
      result.rest_s ? seconds_text(*result.rest_s) : "-",
      result.step_s ? fmt::format("{:.1f}", 1e6 * *result.step_s) : "-", verdict(result), said);
}

std::string counts(const std::vector<TrialResult>& results) {
  const auto [passed, failed, not_tried] = count(results);
  std::string text = fmt::format("{} passed, {} failed", passed, failed);
  if (not_tried > 0) text += fmt::format(", {} not tried", not_tried);
  return text;
}

bool has_passed(const std::vector<TrialResult>& results) {
  const Counts counted = count(results);
  return counted.passed > 0 && counted.failed == 0;
}

std::string to_json(const std::string& deployment, std::uint64_t seed,
                    const std::vector<TrialResult>& results,
                    const std::optional<std::string>& stopped) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const TrialResult& result : results) {
    rows.push_back({{"fault", result.fault},
                    {"form", to_string(result.form)},
                    {"moment_s", result.moment_s},
                    {"arm", result.arm},
                    {"rest_s", number(result.rest_s)},
                    {"step_p999_s", number(result.step_s)},
                    {"shown", result.shown},
                    {"passed", result.passed()},
                    {"not_tried", text_or_null(result.failed() ? "" : result.untried)}});
  }
  const auto [passed, failed, not_tried] = count(results);
  nlohmann::ordered_json json{{"deployment", deployment}, {"seed", seed},
                              {"faults", rows},           {"passed", passed},
                              {"failed", failed},         {"not_tried", not_tried}};
  if (stopped) json["stopped"] = *stopped;
  return json_text(json);
}

}  // namespace armature::drill
