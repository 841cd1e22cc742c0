// SPDX-License-Identifier: Apache-2.0
#include "doctor/doctor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "armature/values/json_text.hpp"
#include "colour.hpp"
#include "doctor/gather.hpp"
#include "doctor/judge.hpp"
#include "exit_code.hpp"
#include "standard_output.hpp"

namespace armature::doctor {
namespace {

std::ptrdiff_t count_of(Level level, const std::vector<Finding>& findings) {
  return std::ranges::count(findings, level, &Finding::level);
}

void print_json(const std::vector<Finding>& findings) {
  nlohmann::ordered_json all{{"problems", count_of(Level::problem, findings)},
                             {"warnings", count_of(Level::warning, findings)},
                             {"findings", nlohmann::ordered_json::array()}};
  for (const Finding& finding : findings) {
    all["findings"].push_back({{"level", to_string(finding.level)},
                               {"what", finding.what},
                               {"value", finding.value},
                               {"meaning", finding.meaning},
                               {"hint", finding.hint}});
  }
  // A file's name may be no UTF-8.
  print_out("{}\n", json_text(all));
}

/// A reason may have several lines; a finding has one.
std::string one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

std::string level_text(Level level) {
  const Tone tone = level == Level::problem   ? Tone::bad
                    : level == Level::warning ? Tone::doubtful
                                              : Tone::good;
  return coloured(fmt::format("{:<8}", to_string(level)), tone, standard_output());
}

void print_text(const std::vector<Finding>& findings) {
  for (const Finding& finding : findings) {
    print_out("{} {:<22} {}; {}{}\n", level_text(finding.level), finding.what,
              one_line(finding.value), finding.meaning,
              finding.hint.empty() ? "" : "; try: " + finding.hint);
  }
}

}  // namespace
}  // namespace armature::doctor

namespace armature {

int examine_machine(bool json) {
  const auto findings = doctor::judge(doctor::facts_of_this_machine());
  json ? doctor::print_json(findings) : doctor::print_text(findings);
  return doctor::count_of(doctor::Level::problem, findings) == 0 ? kOk : kFailed;
}

}  // namespace armature
