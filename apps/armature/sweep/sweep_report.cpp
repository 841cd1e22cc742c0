// SPDX-License-Identifier: Apache-2.0
#include "sweep/sweep_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "armature/plot/chart.hpp"
#include "armature/runtime/deployment_file/goals.hpp"
#include "armature/runtime/reporting/write_atomically.hpp"
#include "colour.hpp"
#include "csv_field.hpp"
#include "standard_output.hpp"

namespace armature::sweep {
namespace {

using Json = nlohmann::ordered_json;

std::string name_of(const RunSpread& spread) {
  return spread.variation.empty() ? "all" : fmt::format("{}", fmt::join(spread.variation, ", "));
}

/// Runs of several combinations are not independent, and tell no interval.
QuantileInterval p95_of(const Spread& spread, bool is_pooled) {
  return is_pooled ? QuantileInterval{} : quantile_interval(spread.values, 0.95);
}

/// A bound that there are too few runs for is a dash.
std::string bound_text(const std::optional<double>& bound) {
  return bound ? fmt::format("{:.4g}", *bound) : "-";
}

std::string text_of(const Spread& spread, std::size_t width, bool is_pooled) {
  if (spread.values.empty()) {
    return fmt::format("  {:<{}}  {:>5}  {}\n", spread.figure, width, 0,
                       spread.runs() > 0 ? "not measured" : "does not apply");
  }
  const QuantileInterval p95 = p95_of(spread, is_pooled);
  std::string text = fmt::format("  {:<{}}  {:>5}  {:>10.4g}  {:>10.4g}  [{}, {}]", spread.figure,
                                 width, spread.values.size(), spread.median(), spread.p95(),
                                 bound_text(p95.low), bound_text(p95.high));
  text = fmt::format("{:<{}}  {:>10.4g}  {:>10.4g}", text, width + 57, spread.max(), spread.rms());
  if (spread.goal) {
    const Bounds met = share_interval(spread.met, spread.runs());
    text +=
        fmt::format("  {:>8g}  {:>5.1f} %", *spread.goal,
                    100.0 * static_cast<double>(spread.met) / static_cast<double>(spread.runs()));
    if (!is_pooled) text += fmt::format(" [{:.1f}, {:.1f}]", 100 * met.low, 100 * met.high);
  }
  if (spread.inapplicable > 0) {
    text += fmt::format("  does not apply to {} more", spread.inapplicable);
  }
  return text + '\n';
}

std::string text_of(const JudgedSweepGoal& judged) {
  const SweepGoal& goal = judged.goal;
  if (!judged.applies) {
    return fmt::format("  {}, {}: does not apply to any run\n", goal.metric,
                       to_string(goal.statistic));
  }
  std::string wanted;
  if (goal.at_least) wanted = fmt::format("at least {:g}", *goal.at_least);
  if (goal.at_most) {
    wanted += fmt::format("{}at most {:g}", wanted.empty() ? "" : ", ", *goal.at_most);
  }
  const std::string what = goal.statistic == SweepGoal::Statistic::share
                               ? fmt::format("share of runs at most {:g}", goal.share_of)
                               : std::string{to_string(goal.statistic)};
  const bool is_met = judged.fault.empty();
  return fmt::format("  {}, {}: {:.4g}; {}  {}\n", goal.metric, what, judged.value, wanted,
                     is_met ? coloured("met", Tone::good, standard_output())
                            : coloured("MISSED: " + judged.fault, Tone::bad, standard_output()));
}

std::string csv_of(const std::vector<RunSpread>& spreads) {
  std::string csv =
      "variation,figure,runs,not_measured,median,p95,p95_low,p95_high,greatest,rms,goal,met,"
      "does_not_apply\r\n";
  for (const RunSpread& one : spreads) {
    for (const Spread& spread : one.figures) {
      if (spread.values.empty()) continue;
      const QuantileInterval p95 = p95_of(spread, one.is_pooled);
      const auto bound = [](const std::optional<double>& value) {
        return value ? fmt::format("{}", *value) : "";
      };
      csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\r\n", csv_field(name_of(one)),
                         spread.figure, spread.values.size(), spread.unmeasured, spread.median(),
                         spread.p95(), bound(p95.low), bound(p95.high), spread.max(), spread.rms(),
                         spread.goal ? fmt::format("{}", *spread.goal) : "",
                         spread.goal ? fmt::format("{}", spread.met) : "", spread.inapplicable);
    }
  }
  return csv;
}

/// As steps: two points for each of its columns.
plot::Curve histogram_of(const std::vector<double>& sorted, double low, double high,
                         std::size_t in_legend) {
  constexpr int kColumns = 30;
  // Of one value alone a column that the value is not lost in.
  const double one = low == 0 ? 1 : 0.01 * std::abs(low) / kColumns;
  const double width = high > low ? (high - low) / kColumns : one;
  std::vector<double> counts(kColumns);
  for (const double value : sorted) {
    const auto column = static_cast<std::size_t>(
        std::clamp(static_cast<int>((value - low) / width), 0, kColumns - 1));
    counts[column] += 1;
  }
  plot::Curve curve{.in_legend = in_legend, .x = {low}, .y = {0}};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    for (const std::size_t edge : {i, i + 1}) {
      curve.x.push_back(low + static_cast<double>(edge) * width);
      curve.y.push_back(counts[i]);
    }
  }
  curve.x.push_back(curve.x.back());
  curve.y.push_back(0);
  return curve;
}

plot::Chart chart_of(const std::string& figure, const std::vector<RunSpread>& spreads) {
  plot::Chart chart{.title = "Runs by " + figure, .x = {.label = figure}};
  plot::Panel& panel = chart.panels.emplace_back();
  panel.y.label = "runs";
  std::vector<std::pair<std::string, const Spread*>> curves;
  for (const RunSpread& one : spreads) {
    const auto spread = std::ranges::find(one.figures, figure, &Spread::figure);
    if (spread != one.figures.end() && !spread->values.empty()) {
      curves.emplace_back(name_of(one), &*spread);
    }
  }
  double low = curves.front().second->values.front(), high = low;
  for (const auto& [name, spread] : curves) {
    low = std::min(low, spread->values.front());
    high = std::max(high, spread->values.back());
  }
  for (const auto& [name, spread] : curves) {
    panel.curves.push_back(histogram_of(spread->values, low, high, chart.legend.size()));
    chart.legend.push_back(plot::line_of(chart.legend.size(), name));
  }
  return chart;
}

}  // namespace

std::string to_text(const RunSpread& spread) {
  std::size_t width = 6;
  for (const Spread& figure : spread.figures) width = std::max(width, figure.figure.size());
  std::string text;
  if (!spread.variation.empty()) text += name_of(spread) + '\n';
  text += fmt::format("  {:<{}}  {:>5}  {:>10}  {:>10}  {:<22}  {:>10}  {:>10}  {:>8}  {}\n",
                      "figure", width, "runs", "median", "p95", "[95 % interval]", "greatest",
                      "rms", "goal", "met [95 % interval]");
  for (const Spread& figure : spread.figures) text += text_of(figure, width, spread.is_pooled);
  text += "  runs: ";
  for (const auto& [status, count] : spread.statuses) text += fmt::format("{} {}  ", count, status);
  text += '\n';
  constexpr std::size_t kShown = 10;
  for (std::size_t i = 0; i < std::min(kShown, spread.failed.size()); ++i) {
    const FailedRun& run = spread.failed[i];
    text += fmt::format("  seed {}: {}{}{}\n", run.seed, run.status, run.reason.empty() ? "" : ", ",
                        run.reason);
  }
  if (spread.failed.size() > kShown) {
    text += fmt::format("  and {} more\n", spread.failed.size() - kShown);
  }
  if (!spread.goals.empty()) text += "sweep goals\n";
  for (const JudgedSweepGoal& goal : spread.goals) text += text_of(goal);
  return text;
}

Json to_json(const RunSpread& spread) {
  Json json{{"variation", spread.variation}, {"ok", spread.is_ok()}};
  json["statuses"] = Json::object();
  for (const auto& [status, count] : spread.statuses) json["statuses"][status] = count;
  json["failed"] = Json::array();
  for (const FailedRun& run : spread.failed) {
    json["failed"].push_back({{"seed", run.seed}, {"status", run.status}, {"reason", run.reason}});
  }
  json["figures"] = Json::object();
  for (const Spread& figure : spread.figures) {
    Json one{{"runs", figure.values.size()}, {"not_measured", figure.unmeasured}};
    if (figure.inapplicable > 0) one["does_not_apply"] = figure.inapplicable;
    if (!figure.values.empty()) {
      const QuantileInterval p95 = p95_of(figure, spread.is_pooled);
      const auto bound = [](const std::optional<double>& value) {
        return value ? Json(*value) : Json(nullptr);
      };
      one.update({{"median", figure.median()},
                  {"p95", figure.p95()},
                  {"p95_interval", {bound(p95.low), bound(p95.high)}},
                  {"greatest", figure.max()},
                  {"rms", figure.rms()}});
    }
    if (figure.goal) one.update({{"goal", *figure.goal}, {"met", figure.met}});
    json["figures"][figure.figure] = std::move(one);
  }
  json["sweep_goals"] = Json::array();
  for (const JudgedSweepGoal& goal : spread.goals) {
    Json one{{"figure", goal.goal.metric},
             {"statistic", to_string(goal.goal.statistic)},
             {"value", goal.value}};
    if (goal.applies) {
      one["met"] = goal.fault.empty();
    } else {
      one["does_not_apply"] = true;
    }
    if (goal.goal.at_least) one["at_least"] = *goal.goal.at_least;
    if (goal.goal.at_most) one["at_most"] = *goal.goal.at_most;
    if (goal.goal.statistic == SweepGoal::Statistic::share) one["share_of"] = goal.goal.share_of;
    if (!goal.fault.empty()) one["fault"] = goal.fault;
    json["sweep_goals"].push_back(std::move(one));
  }
  return json;
}

void write_files(const std::filesystem::path& folder, const std::vector<RunSpread>& spreads) {
  constexpr FileUse kUse = FileUse::named_by_user;
  write_atomically(folder / "figures.csv", csv_of(spreads), kUse);
  std::set<std::string> figures;
  for (const RunSpread& one : spreads) {
    for (const Spread& figure : one.figures) {
      if (!figure.values.empty()) figures.insert(figure.figure);
    }
  }
  for (const std::string& figure : figures) {
    write_atomically(folder / (figure + ".svg"), plot::to_svg(chart_of(figure, spreads)), kUse);
  }
}

}  // namespace armature::sweep
