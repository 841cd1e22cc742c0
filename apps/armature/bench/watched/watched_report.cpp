// SPDX-License-Identifier: Apache-2.0
#include "bench/watched/watched_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "armature/values/json_text.hpp"
#include "bench/statistics.hpp"

namespace armature::bench {
namespace {

std::size_t place(Watching watching) { return static_cast<std::size_t>(watching); }

std::string title(Watching watching, const WatchedBenchOptions& options) {
  switch (watching) {
    case Watching::alone: return "alone";
    case Watching::recorded: return "recorded by itself";
    case Watching::read: return fmt::format("read by a recorder and {} others", options.readers);
  }
  return {};
}

const char* key(Watching watching) {
  constexpr std::array kKeys{"alone", "recorded", "read"};
  return kKeys[place(watching)];
}

/// What `run` would have taken for the cycles of `alone` [s].
double own_s(const WatchedRun& run, const WatchedRun& alone) {
  double sum = 0;
  for (const auto& [name, time] : alone.own) {
    const auto same = run.own.find(name);
    if (same == run.own.end() || same->second.cycles == 0) continue;
    sum += same->second.processor_s / static_cast<double>(same->second.cycles) *
           static_cast<double>(time.cycles);
  }
  return sum;
}

std::uint64_t lost(const WatchedReport& report, Watching watching) {
  return std::accumulate(report.rounds.begin(), report.rounds.end(), std::uint64_t{0},
                         [&](std::uint64_t sum, const WatchedRound& round) {
                           return sum + round[place(watching)].lost;
                         });
}

bool is_met(const WatchedReport& report, Watching watching) {
  return median_ratio(report, watching) <= kMaxWatchedRatio && lost(report, watching) == 0;
}

}  // namespace

double median_ratio(const WatchedReport& report, Watching watching) {
  return median_over(report.rounds, [&](const WatchedRound& round) {
    const WatchedRun& alone = round[place(Watching::alone)];
    return own_s(round[place(watching)], alone) / own_s(alone, alone);
  });
}

bool is_met(const WatchedReport& report) {
  return std::ranges::all_of(kWatching,
                             [&](Watching watching) { return is_met(report, watching); });
}

std::string table(const WatchedReport& report) {
  std::string text =
      fmt::format("{:<36} {:>12} {:>8} {:>14} {:>6}\n", "processor time [ms/s], medians",
                  "own threads", "ratio", "other threads", "lost");
  for (const Watching watching : kWatching) {
    const auto own = [&](const WatchedRound& round) {
      return own_s(round[place(watching)], round[place(Watching::alone)]);
    };
    const auto others = [&](const WatchedRound& round) { return round[place(watching)].others_s; };
    text += fmt::format("{:<36} {:>12.1f} {:>8.3f} {:>14.1f} {:>6}{}\n",
                        title(watching, report.options),
                        1e3 * median_over(report.rounds, own) / report.options.seconds,
                        median_ratio(report, watching),
                        1e3 * median_over(report.rounds, others) / report.options.seconds,
                        lost(report, watching), is_met(report, watching) ? "" : "  MISSED");
  }
  return text + fmt::format(
                    "\ngoal: at most {:g} times the time of the own threads alone, and nothing "
                    "lost: {}\n{} rounds of {:g} s each\n{}\n",
                    kMaxWatchedRatio, is_met(report) ? "met" : "MISSED", report.rounds.size(),
                    report.options.seconds, to_text(report.machine));
}

std::string to_json(const WatchedReport& report) {
  nlohmann::ordered_json json{{"seconds", report.options.seconds},
                              {"readers", report.options.readers},
                              {"goal", kMaxWatchedRatio}};
  for (const Watching watching : kWatching) {
    auto runs = nlohmann::ordered_json::array();
    for (const WatchedRound& round : report.rounds) {
      const WatchedRun& run = round[place(watching)];
      nlohmann::ordered_json own;
      for (const auto& [name, time] : run.own) {
        own[name] = {{"processor_s", time.processor_s}, {"cycles", time.cycles}};
      }
      runs.push_back({{"own", std::move(own)}, {"others_s", run.others_s}, {"lost", run.lost}});
    }
    json[key(watching)] = {{"median_ratio", median_ratio(report, watching)},
                           {"lost", lost(report, watching)},
                           {"met", is_met(report, watching)},
                           {"runs", std::move(runs)}};
  }
  json["met"] = is_met(report);
  json["machine"] = to_json(report.machine);
  return json_text(json);
}

}  // namespace armature::bench
