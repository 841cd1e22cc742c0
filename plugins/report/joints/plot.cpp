// SPDX-License-Identifier: Apache-2.0
#include "plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

namespace armature::report::joints {
namespace {

// All in user units of the picture.
constexpr double kWidth = 1000, kLeft = 76, kRight = 984, kPanelHeight = 150, kPanelGap = 46;
constexpr double kTitleHeight = 34, kLegendLine = 20, kBottom = 30;
constexpr double kLetter = 7.5;  // of 13 high, at most on average

constexpr std::array kColours{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                              "#E69F00", "#56B4E9", "#777777"};

template <class... Args>
void append(std::string& svg, fmt::format_string<Args...> format, Args&&... args) {
  fmt::format_to(std::back_inserter(svg), format, std::forward<Args>(args)...);
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      default:  // other control characters are none in XML
        safe += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
  }
  return safe;
}

/// The least of 1, 2, 5 times a power of ten that makes at most `most` steps over `range`.
double tick_step(double range, int most) {
  const double power = std::pow(10, std::floor(std::log10(range / most)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power * most >= range) return factor * power;
  }
  return 10 * power;
}

/// From values to places along one axis of the picture.
struct Axis {
  double low, high;  // values; of a logarithmic one their powers of ten
  double from, to;   // places
  bool is_logarithmic = false;

  double at(double value) const {
    const double v = is_logarithmic ? std::log10(std::max(value, std::pow(10, low))) : value;
    return from + (to - from) * (v - low) / (high - low);
  }
};

Axis time_axis(const Envelope& envelope) {
  const auto& stretches = envelope.stretches();
  const double end_s = stretches.empty() ? 1 : stretches.back().end_s;
  return {.low = 0, .high = std::max(end_s, 0.1), .from = kLeft, .to = kRight};
}

Envelope::Range range_of(const Panel& panel, const Envelope& envelope) {
  Envelope::Range range;
  for (const Panel::Curve& curve : panel.curves) range.include(envelope.range(curve.in_envelope));
  return range;
}

Axis value_axis(const Panel& panel, const Envelope& envelope, double top) {
  const Envelope::Range range = range_of(panel, envelope);
  Axis axis{.low = 0,
            .high = 0,
            .from = top + kPanelHeight,
            .to = top,
            .is_logarithmic = panel.is_logarithmic};
  if (panel.is_logarithmic) {
    axis.low = std::floor(std::log10(std::max(range.low, panel.min_span)));
    axis.high = std::max(std::ceil(std::log10(std::max(range.high, panel.min_span))), axis.low + 1);
  } else {
    const double middle = (range.low + range.high) / 2;
    const double half = std::max(range.high - range.low, panel.min_span) * 0.55;
    axis.low = middle - half;
    axis.high = middle + half;
  }
  return axis;
}

void draw_level(double y, const std::string& label, std::string& svg) {
  append(svg, "<path class=\"grid\" d=\"M{},{:.1f}H{}\"/>\n", kLeft, y, kRight);
  append(svg, "<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n", kLeft - 6, y + 4,
         label);
}

void draw_values(const Axis& axis, std::string& svg) {
  if (axis.is_logarithmic) {
    constexpr int kMaxLabels = 6;
    const int step = 1 + static_cast<int>(axis.high - axis.low - 1) / kMaxLabels;
    for (int power = static_cast<int>(axis.high); power >= axis.low; power -= step) {
      draw_level(axis.at(std::pow(10, power)),
                 fmt::format("10<tspan dy=\"-5\" font-size=\"10\">{}</tspan>", power), svg);
    }
    return;
  }
  const double step = tick_step(axis.high - axis.low, 5);
  const auto last = std::llround(std::floor(axis.high / step));
  for (auto k = std::llround(std::ceil(axis.low / step)); k <= last; ++k) {
    const double value = static_cast<double>(k) * step;
    draw_level(axis.at(value), fmt::format("{:g}", value), svg);
  }
}

void draw_times(const Axis& time, double top, std::string& svg) {
  const double step = tick_step(time.high, 10);
  const double bottom = top + kPanelHeight;
  for (int k = 0; k * step <= time.high * 1.0001; ++k) {
    const double x = time.at(k * step);
    append(svg, "<path class=\"grid\" d=\"M{:.1f},{:.1f}V{:.1f}\"/>\n", x, top, bottom);
    append(svg, "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{:g}</text>\n", x,
           bottom + 16, k * step);
  }
}

/// Through the least and the greatest value of each stretch, first the one that is nearer to where
/// the curve comes from; a stretch without one is a gap.
std::string path_of(std::size_t curve, const Axis& time, const Axis& value,
                    const Envelope& envelope) {
  std::string path;
  std::optional<double> before;
  for (const Envelope::Stretch& stretch : envelope.stretches()) {
    const auto [low, high] = stretch.ranges[curve];
    if (!stretch.ranges[curve].known()) {
      before.reset();
      continue;
    }
    const bool falls = before && std::abs(*before - high) < std::abs(*before - low);
    const double first = falls ? high : low, second = falls ? low : high;
    append(path, "{}{:.1f},{:.1f}", before ? 'L' : 'M', time.at(stretch.begin_s), value.at(first));
    before = second;
    if (stretch.samples == 1) continue;
    append(path, "L{:.1f},{:.1f}", time.at(stretch.end_s), value.at(second));
  }
  return path;
}

void draw_panel(const Panel& panel, const std::vector<Line>& legend, const Axis& time,
                const Envelope& envelope, double top, std::string& svg) {
  const Axis value = value_axis(panel, envelope, top);
  draw_times(time, top, svg);
  draw_values(value, svg);
  for (const Panel::Curve& curve : panel.curves) {
    append(svg, "<path class=\"curve\" {} d=\"{}\"><title>{}</title></path>\n",
           legend[curve.in_legend].stroke, path_of(curve.in_envelope, time, value, envelope),
           escaped(legend[curve.in_legend].name));
  }
  append(svg, "<rect class=\"frame\" x=\"{}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\"/>\n", kLeft,
         top, kRight - kLeft, kPanelHeight);
  append(svg, "<text class=\"head\" x=\"{}\" y=\"{:.1f}\">{}</text>\n", kLeft, top - 7,
         escaped(panel.title));
}

/// In as many lines as it needs; returns where it ends.
double draw_legend(const std::vector<Line>& legend, std::string& svg) {
  constexpr double kSample = 26, kSpace = 18;
  double x = kLeft, y = kTitleHeight + kLegendLine / 2;
  for (std::size_t i = 0; i < legend.size(); ++i) {
    const double width = kSample + 6 + kLetter * static_cast<double>(legend[i].name.size());
    if (x > kLeft && x + width > kRight) {
      x = kLeft;
      y += kLegendLine;
    }
    append(svg, "<path class=\"curve\" {} d=\"M{:.1f},{:.1f}h{}\"/>\n", legend[i].stroke, x, y - 4,
           kSample);
    append(svg, "<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x + kSample + 6, y,
           escaped(legend[i].name));
    x += width + kSpace;
  }
  return y;
}

}  // namespace

Line line_of(std::size_t i, std::string name) {
  const char* dashes = i < kColours.size() ? "" : " stroke-dasharray=\"7 3\"";
  return {std::move(name), fmt::format("stroke=\"{}\"{}", kColours[i % kColours.size()], dashes)};
}

Line black_line(std::string name) { return {std::move(name), "stroke=\"#000000\""}; }

std::string to_svg(const std::string& title, const std::vector<Line>& legend,
                   const std::vector<Panel>& panels, const Envelope& envelope) {
  std::string drawn;
  const Axis time = time_axis(envelope);
  double bottom = draw_legend(legend, drawn);
  for (const Panel& panel : panels) {
    if (!range_of(panel, envelope).known()) continue;
    const double top = bottom + kPanelGap;
    draw_panel(panel, legend, time, envelope, top, drawn);
    bottom = top + kPanelHeight;
  }
  append(drawn, "<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">time [s]</text>\n", kRight,
         bottom + kBottom);
  std::string svg;
  append(svg,
         "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1:.0f}\" width=\"{0}\" "
         "height=\"{1:.0f}\" font-family=\"sans-serif\" font-size=\"13\">\n"
         "<style>.grid{{stroke:#ddd}} .frame{{fill:none;stroke:#000}} "
         ".curve{{fill:none;stroke-width:1.6;stroke-linejoin:round}} .head{{font-size:14px}} "
         ".title{{font-size:17px}}</style>\n"
         "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
         "<text class=\"title\" x=\"{2}\" y=\"24\">{3}</text>\n",
         kWidth, bottom + kBottom + 14, kLeft, escaped(title));
  return svg + drawn + "</svg>\n";
}

}  // namespace armature::report::joints
