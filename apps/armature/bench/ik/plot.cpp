// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/ik/report.hpp"

namespace armature::bench {
namespace {

constexpr double kWidth = 900, kHeight = 520;
constexpr double kLeft = 70, kRight = 660, kTop = 60, kBottom = 460;  // of the axes
constexpr int kPoints = 400;                                          // of a line
constexpr std::array kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                              "#e69f00", "#56b4e9", "#000000", "#999999"};

/// Logarithmic, from 10^first to 10^last microseconds.
struct TimeAxis {
  double first, last;
  double x(double seconds) const {
    const double part = (std::log10(1e6 * seconds) - first) / (last - first);
    return kLeft + std::clamp(part, 0.0, 1.0) * (kRight - kLeft);
  }
};
double y(double part) { return kBottom - part * (kBottom - kTop); }

TimeAxis axis_of(const std::vector<Series>& all) {
  constexpr double kShortest = 1e-9;  // [s] what is under the clock's step
  double least = 1, most = kShortest;
  for (const Series& series : all) {
    for (const Solve& solve : series.solves) {
      least = std::min(least, std::max(solve.seconds, kShortest));
      most = std::max(most, solve.seconds);
    }
  }
  const double first = std::floor(std::log10(1e6 * least));
  return {first, std::max(std::ceil(std::log10(1e6 * most)), first + 1)};
}

std::string text_at(double x_px, double y_px, const char* anchor, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x_px, y_px,
                     anchor, text);
}

std::string grid(const TimeAxis& axis) {
  std::string svg;
  for (double power = axis.first; power <= axis.last; ++power) {
    const double at = axis.x(1e-6 * std::pow(10, power));
    svg += fmt::format("<path class=\"grid\" d=\"M{:.1f} {}V{}\"/>\n", at, kTop, kBottom);
    svg += text_at(at, kBottom + 20, "middle", fmt::format("{:g}", std::pow(10, power)));
  }
  for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    svg += fmt::format("<path class=\"grid\" d=\"M{} {:.1f}H{}\"/>\n", kLeft, y(part), kRight);
    svg += text_at(kLeft - 8, y(part) + 4, "end", fmt::format("{:g} %", 100 * part));
  }
  return svg + text_at((kLeft + kRight) / 2, kBottom + 45, "middle", "time of a solve [us]");
}

std::string line_of(const Series& series, const TimeAxis& axis, const std::string& colour) {
  std::vector<double> seconds = series.seconds();
  std::ranges::sort(seconds);
  std::string path;
  for (int i = 0; i <= kPoints; ++i) {
    const double part = static_cast<double>(i) / kPoints;
    const auto place = static_cast<std::size_t>(part * static_cast<double>(seconds.size() - 1));
    path += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", axis.x(seconds[place]), y(part));
  }
  return fmt::format("<path class=\"line\" stroke=\"{}\"{} d=\"{}\"/>\n", colour,
                     series.seeds == Seeds::near ? " stroke-dasharray=\"6 4\"" : "", path);
}

std::string legend_of(const Series& series, const std::string& colour, int row) {
  const double at = kTop + 12 + 20 * row;
  return fmt::format("<path class=\"line\" stroke=\"{}\"{} d=\"M{} {:.1f}h30\"/>\n", colour,
                     series.seeds == Seeds::near ? " stroke-dasharray=\"6 4\"" : "", kRight + 15,
                     at) +
         text_at(kRight + 52, at + 4, "start",
                 fmt::format("{}, {} seeds", series.plugin, to_string(series.seeds)));
}

}  // namespace

std::string plot_of(const Report& report, const std::vector<Series>& series) {
  const TimeAxis axis = axis_of(series);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\" font-family=\"sans-serif\" font-size=\"12\">\n"
      "<style>.grid{{stroke:#ddd;fill:none}}.line{{fill:none;stroke-width:2}}</style>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      kWidth, kHeight);
  svg += text_at(
      kLeft, 25, "start",
      fmt::format("Inverse kinematics of {}: part of {} goals that were answered in this time",
                  report.robot, report.poses));
  svg += text_at(kLeft, 43, "start",
                 fmt::format("{}; {}; the least of {} repetitions", report.machine.processor,
                             report.machine.compiler, report.repetitions));
  svg += grid(axis);
  std::vector<std::string> plugins;  // one colour each
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (std::ranges::find(plugins, series[i].plugin) == plugins.end()) {
      plugins.push_back(series[i].plugin);
    }
    const std::string colour = kColours[(plugins.size() - 1) % kColours.size()];
    svg += line_of(series[i], axis, colour);
    svg += legend_of(series[i], colour, static_cast<int>(i));
  }
  return svg + "</svg>\n";
}

}  // namespace armature::bench
