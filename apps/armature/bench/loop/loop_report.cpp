// SPDX-License-Identifier: Apache-2.0
#include "bench/loop/loop_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "armature/values/json_text.hpp"
#include "bench/statistics.hpp"

namespace armature::bench {
namespace {

using Json = nlohmann::ordered_json;

double ratio_of(const LoopRound& round) {
  return round.a.lateness.p999_s / round.b.lateness.p999_s;
}

double max_s(const std::vector<LoopRound>& rounds, LoopSide LoopRound::*side) {
  double greatest = 0;
  for (const LoopRound& round : rounds) {
    greatest = std::max(greatest, (round.*side).lateness.max_s);
  }
  return greatest;
}

std::uint64_t total(const std::vector<LoopRound>& rounds, std::uint64_t LoopSide::*count) {
  std::uint64_t sum = 0;
  for (const LoopRound& round : rounds) sum += round.a.*count;
  return sum;
}

bool is_met(const WatchedRounds& watched, double noise) {
  return median_ratio(watched.rounds) <= kMaxRatio * noise &&
         total(watched.rounds, &LoopSide::page_faults) == 0 &&
         total(watched.rounds, &LoopSide::allocations) == 0;
}

std::string rows(const std::string& what, const std::vector<LoopRound>& rounds) {
  std::string text;
  for (const LoopRound& round : rounds) {
    text +=
        fmt::format("{:<22} {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f} {:>7.2f}\n", what,
                    1e6 * round.a.lateness.mean_s, 1e6 * round.a.lateness.p999_s,
                    1e6 * round.a.lateness.max_s, 1e6 * round.b.lateness.mean_s,
                    1e6 * round.b.lateness.p999_s, 1e6 * round.b.lateness.max_s, ratio_of(round));
  }
  return text;
}

std::string name_of(const WatchedRounds& watched) {
  if (watched.everything) return "executor, all watch it";
  return fmt::format("executor, {} readers", watched.readers);
}

Json to_json(const LoopSide& side) {
  return {{"steps", side.lateness.count},   {"mean_s", side.lateness.mean_s},
          {"p99_s", side.lateness.p99_s},   {"p999_s", side.lateness.p999_s},
          {"max_s", side.lateness.max_s},   {"page_faults", side.page_faults},
          {"allocations", side.allocations}};
}

Json to_json(const std::vector<LoopRound>& rounds) {
  Json list = Json::array();
  for (const LoopRound& round : rounds) {
    list.push_back(
        {{"loop", to_json(round.a)}, {"twin", to_json(round.b)}, {"p999_ratio", ratio_of(round)}});
  }
  return list;
}

}  // namespace

double median_ratio(const std::vector<LoopRound>& rounds) {
  std::vector<double> ratios;
  for (const LoopRound& round : rounds) ratios.push_back(ratio_of(round));
  return quantile(std::move(ratios), 0.5);
}

double noise_of(const LoopReport& report) { return std::max(1.0, median_ratio(report.noise)); }

bool is_met(const LoopReport& report) {
  const double noise = noise_of(report);
  return std::ranges::all_of(report.watched,
                             [&](const WatchedRounds& watched) { return is_met(watched, noise); });
}

std::string table(const LoopReport& report) {
  std::string text =
      fmt::format("{:<22} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>7}\n", "lateness [us]", "mean",
                  "p99.9", "max", "twin mean", "p99.9", "max", "ratio");
  text += rows("twin", report.noise);
  for (const WatchedRounds& watched : report.watched)
    text += rows(name_of(watched), watched.rounds);
  const double noise = noise_of(report);
  text += fmt::format("\nmedian ratio of p99.9, two twins: {:.2f}\n", median_ratio(report.noise));
  for (const WatchedRounds& watched : report.watched) {
    text += fmt::format(
        "{}: median ratio {:.2f} ({:.2f} of the twins', goal {:g}), greatest lateness {:.0f} us, "
        "{} "
        "page faults, {} allocations: {}\n",
        name_of(watched), median_ratio(watched.rounds), median_ratio(watched.rounds) / noise,
        kMaxRatio, 1e6 * max_s(watched.rounds, &LoopRound::a),
        total(watched.rounds, &LoopSide::page_faults),
        total(watched.rounds, &LoopSide::allocations), is_met(watched, noise) ? "met" : "MISSED");
  }
  if (report.options.everything) {
    text +=
        fmt::format("all: {} readers, a recorder of all topics, a page, and it records itself\n",
                    report.watched.back().readers);
  }
  for (const std::string& note : report.notes) text += fmt::format("note: {}\n", note);
  return text +
         fmt::format(
             "{} rounds of {:g} s at {:g} s, half of each on the other processor; SCHED_FIFO "
             "{} (0: normal)\n{}\n",
             report.options.rounds, report.options.seconds, report.options.period_s,
             report.options.priority, to_text(report.machine));
}

std::string to_json(const LoopReport& report) {
  const double noise = noise_of(report);
  Json json{
      {"rounds", report.options.rounds},
      {"seconds", report.options.seconds},
      {"period_s", report.options.period_s},
      {"priority", report.options.priority},
      {"machine", to_json(report.machine)},
      {"notes", report.notes},
      {"twins",
       {{"median_p999_ratio", median_ratio(report.noise)}, {"rounds", to_json(report.noise)}}},
      {"executor", Json::array()}};
  for (const WatchedRounds& watched : report.watched) {
    const double ratio = median_ratio(watched.rounds);
    json["executor"].push_back({{"readers", watched.readers},
                                {"everything", watched.everything},
                                {"median_p999_ratio", ratio},
                                {"of_the_twins", ratio / noise},
                                {"goal", kMaxRatio},
                                {"max_s", max_s(watched.rounds, &LoopRound::a)},
                                {"page_faults", total(watched.rounds, &LoopSide::page_faults)},
                                {"allocations", total(watched.rounds, &LoopSide::allocations)},
                                {"met", is_met(watched, noise)},
                                {"rounds", to_json(watched.rounds)}});
  }
  return json_text(json);
}

}  // namespace armature::bench
