// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "armature/plot/chart.hpp"
#include "bench/ik/report.hpp"

namespace armature::bench {
namespace {

constexpr double kShortest_us = 1e-3;  // what is under the clock's step
constexpr int kPoints = 400;           // of a line

plot::Curve curve_of(const Series& series, std::size_t in_legend) {
  std::vector<double> seconds = series.seconds();
  std::ranges::sort(seconds);
  plot::Curve curve{.in_legend = in_legend, .x = {}, .y = {}};
  for (int i = 0; i <= kPoints; ++i) {
    const double part = static_cast<double>(i) / kPoints;
    const auto place = static_cast<std::size_t>(part * static_cast<double>(seconds.size() - 1));
    curve.x.push_back(std::max(1e6 * seconds[place], kShortest_us));
    curve.y.push_back(100 * part);
  }
  return curve;
}

}  // namespace

std::string plot_of(const Report& report, const std::vector<Series>& series) {
  plot::Chart chart{.title = fmt::format("Inverse kinematics of {}", report.robot),
                    .x = {.label = "time of a solve [us]", .is_logarithmic = true}};
  plot::Panel& panel = chart.panels.emplace_back();
  panel.y.label = fmt::format(
      "part of {} goals that were answered in this time [%]; {}; {}; the least of {} repetitions",
      report.poses, report.machine.processor, report.machine.compiler, report.repetitions);
  std::map<std::string, std::size_t> colours;  // one for each plugin
  for (const Series& one : series) {
    const std::size_t colour = colours.try_emplace(one.plugin, colours.size()).first->second;
    std::string name = fmt::format("{}, {} seeds", one.plugin, to_string(one.seeds));
    panel.curves.push_back(curve_of(one, chart.legend.size()));
    chart.legend.push_back(one.seeds == Seeds::near ? plot::dashed_line(colour, std::move(name))
                                                    : plot::line_of(colour, std::move(name)));
  }
  return plot::to_svg(chart);
}

}  // namespace armature::bench
