// SPDX-License-Identifier: Apache-2.0
#include "bench/bus/bus_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "armature/values/json_text.hpp"
#include "bench/statistics.hpp"

namespace armature::bench {
namespace {

using Part = TripTimes BusRound::*;

struct NamedPart {
  const char* key;
  const char* title;
  Part part;
};

constexpr std::array<NamedPart, 7> kParts{{
    {"hand_over_here", "a thread wakes another", &BusRound::hand_over_here},
    {"hand_over_across", "the same on another processor", &BusRound::hand_over_across},
    {"hop", "from publishing to a step there", &BusRound::hop},
    {"plain_small", "64 B to a process and back, Fast DDS", &BusRound::plain_small},
    {"small", "the same by topics", &BusRound::small},
    {"plain_picture", "a picture, Fast DDS", &BusRound::plain_picture},
    {"picture", "the same by topics", &BusRound::picture},
}};

double allowed_small_excess_s(const BusReport& report) {
  return kMaxHandOvers * median_over(report.rounds, [](const BusRound& round) {
           return round.hand_over_across.p50_s;
         });
}

bool is_hop_met(const BusReport& report) {
  return median_excess_s(report, &BusRound::hop, &BusRound::hand_over_across) <= kMaxHopExcess_s;
}
bool is_small_met(const BusReport& report) {
  return median_excess_s(report, &BusRound::small, &BusRound::plain_small) <=
         allowed_small_excess_s(report);
}
bool is_picture_met(const BusReport& report) {
  return median_ratio(report, &BusRound::picture, &BusRound::plain_picture) <= kMaxPictureRatio;
}

const char* verdict(bool met) { return met ? "met" : "MISSED"; }

}  // namespace

double median_excess_s(const BusReport& report, Part a, Part b) {
  return median_over(report.rounds,
                     [&](const BusRound& round) { return (round.*a).p50_s - (round.*b).p50_s; });
}

double median_ratio(const BusReport& report, Part a, Part b) {
  return median_over(report.rounds,
                     [&](const BusRound& round) { return (round.*a).p50_s / (round.*b).p50_s; });
}

bool is_met(const BusReport& report) {
  return is_hop_met(report) && is_small_met(report) && is_picture_met(report);
}

std::string table(const BusReport& report) {
  std::string text =
      fmt::format("{:<38} {:>9} {:>9}\n", "[us], medians of the rounds", "p50", "p99");
  for (const auto& [key, title, part] : kParts) {
    text +=
        fmt::format("{:<38} {:>9.1f} {:>9.1f}\n", title,
                    1e6 * median_over(report.rounds,
                                      [&](const BusRound& round) { return (round.*part).p50_s; }),
                    1e6 * median_over(report.rounds,
                                      [&](const BusRound& round) { return (round.*part).p99_s; }));
  }
  text += fmt::format("\na hop takes {:.1f} us longer than to wake a thread (goal {:g}): {}\n",
                      1e6 * median_excess_s(report, &BusRound::hop, &BusRound::hand_over_across),
                      1e6 * kMaxHopExcess_s, verdict(is_hop_met(report)));
  text += fmt::format(
      "64 B there and back take {:.1f} us longer than with Fast DDS alone, {:.2f} times as long "
      "(goal {:.1f} us: {} wakes on another processor): {}\n",
      1e6 * median_excess_s(report, &BusRound::small, &BusRound::plain_small),
      median_ratio(report, &BusRound::small, &BusRound::plain_small),
      1e6 * allowed_small_excess_s(report), kMaxHandOvers, verdict(is_small_met(report)));
  text += fmt::format("a picture of {} B takes {:.2f} times as long (goal {:g}): {}\n",
                      report.options.picture_bytes,
                      median_ratio(report, &BusRound::picture, &BusRound::plain_picture),
                      kMaxPictureRatio, verdict(is_picture_met(report)));
  return text + fmt::format("{} rounds in turn, a process on each of two processors\n{}\n",
                            report.rounds.size(), to_text(report.machine));
}

std::string to_json(const BusReport& report) {
  nlohmann::ordered_json json{{"rounds", nlohmann::ordered_json::array()}};
  for (const BusRound& round : report.rounds) {
    nlohmann::ordered_json parts;
    for (const auto& [key, title, part] : kParts) {
      parts[key] = {{"p50_s", (round.*part).p50_s}, {"p99_s", (round.*part).p99_s}};
    }
    json["rounds"].push_back(std::move(parts));
  }
  json["hop_excess_s"] = median_excess_s(report, &BusRound::hop, &BusRound::hand_over_across);
  json["hop_goal_s"] = kMaxHopExcess_s;
  json["small_excess_s"] = median_excess_s(report, &BusRound::small, &BusRound::plain_small);
  json["small_goal_s"] = allowed_small_excess_s(report);
  json["small_ratio"] = median_ratio(report, &BusRound::small, &BusRound::plain_small);
  json["picture_bytes"] = report.options.picture_bytes;
  json["picture_ratio"] = median_ratio(report, &BusRound::picture, &BusRound::plain_picture);
  json["picture_goal"] = kMaxPictureRatio;
  json["met"] = is_met(report);
  json["machine"] = to_json(report.machine);
  return json_text(json);
}

}  // namespace armature::bench
