// SPDX-License-Identifier: Apache-2.0
#include "record/repaired.hpp"

#include <fmt/format.h>

#include "armature/config/problems.hpp"
#include "armature/runtime/recording/recorded_description.hpp"

namespace armature {
namespace {

/// What was wrong with the file that was repaired or joined; empty: nothing.
std::string wrong_with(const std::string& chain, const std::string& problems) {
  if (chain == "cut") return "cut off";
  if (chain == "changed") return "changed after it was written";
  return problems == "0" ? "" : "not whole";
}

}  // namespace

std::vector<std::string> repairs_told_by(const std::vector<McapMetadata>& metadata,
                                         std::string_view process) {
  std::vector<std::string> told;
  for (const McapMetadata& one : metadata) {
    const bool is_part = one.name == kPartMetadata;
    if (!is_part && one.name != kRepairedMetadata) continue;
    const auto value = [&](const char* key) {
      const auto found = one.values.find(key);
      return found == one.values.end() ? std::string{} : found->second;
    };
    const std::string wrong = wrong_with(value("chain"), value("problems"));
    if (wrong.empty()) continue;
    if (is_part) {
      const std::string of = value("process"), first = value("first_problem");
      if (!process.empty() && of != process) continue;
      told.push_back(fmt::format("the part of process {} was {}{}{}", config::in_quotes(of), wrong,
                                 first.empty() ? "" : ": ", first));
      continue;
    }
    told.push_back(fmt::format("it was repaired from {}, which was {}",
                               config::in_quotes(value("file")), wrong));
  }
  return told;
}

std::vector<std::string> losses_told_by(const std::vector<McapMetadata>& metadata) {
  constexpr std::string_view kLost = "lost of ", kStrays = "strays of ";
  std::vector<std::string> told;
  for (const McapMetadata& one : metadata) {
    if (one.name != kEndMetadata) continue;
    for (const auto& [key, count] : one.values) {
      if (key.starts_with(kLost)) {
        told.push_back(fmt::format("{} calls of {} were not recorded, with all that they published",
                                   count, config::in_quotes(key.substr(kLost.size()))));
      }
      if (key.starts_with(kStrays)) {
        told.push_back(fmt::format("{} messages of threads of {} were not recorded", count,
                                   config::in_quotes(key.substr(kStrays.size()))));
      }
    }
  }
  return told;
}

}  // namespace armature
