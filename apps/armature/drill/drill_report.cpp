// SPDX-License-Identifier: Apache-2.0
#include "drill/drill_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace armature::drill {
namespace {

constexpr const char* kRow = "{:<18} {:<6} {:>7} {:>8} {:>9}  {:<6} {}";

std::string seconds_text(double value) { return fmt::format("{:.2f}", value); }

nlohmann::ordered_json number(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nullptr;
}

std::ptrdiff_t passed(const std::vector<TrialResult>& results) {
  return std::ranges::count_if(results, &TrialResult::passed);
}

}  // namespace

std::string table_head() {
  return fmt::format(fmt::runtime(kRow), "fault", "form", "at [s]", "rest [s]", "step [us]",
                     "result", "what the arm did, and what was shown");
}

std::string table_row(const TrialResult& result) {
  std::string said = result.arm;
  if (!result.shown.empty()) said += fmt::format("\n{:>59} {}", "|", result.shown);
  return fmt::format(fmt::runtime(kRow), result.fault, to_string(result.form),
                     seconds_text(result.moment_s),
                     result.rest_s ? seconds_text(*result.rest_s) : "-",
                     result.step_s ? fmt::format("{:.1f}", 1e6 * *result.step_s) : "-",
                     result.passed() ? "pass" : "FAIL", said);
}

std::string counts(const std::vector<TrialResult>& results) {
  const auto well = passed(results);
  return fmt::format("{} passed, {} failed", well, std::ssize(results) - well);
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
                    {"passed", result.passed()}});
  }
  const auto well = passed(results);
  nlohmann::ordered_json json{{"deployment", deployment},
                              {"seed", seed},
                              {"faults", rows},
                              {"passed", well},
                              {"failed", std::ssize(results) - well}};
  if (stopped) json["stopped"] = *stopped;
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace armature::drill
