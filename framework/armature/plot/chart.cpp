// SPDX-License-Identifier: Apache-2.0
#include "armature/plot/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace armature::plot {
namespace {

// All in user units of the picture.
constexpr double kWidth = 1000, kLeft = 76, kRight = 984, kPanelHeight = 150, kPanelGap = 46;
constexpr double kOnlyPanelHeight = 420;  // of a picture that has but one
constexpr double kEqualHeight = 560;      // of places, at most
constexpr double kTitleHeight = 34, kLegendLine = 20, kBottom = 30;
constexpr double kLetter = 7.5;  // of 13 high, at most on average

constexpr std::array kColours{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                              "#E69F00", "#56B4E9", "#777777"};

template <class... Args>
void append(std::string& svg, fmt::format_string<Args...> format, Args&&... args) {
  fmt::format_to(std::back_inserter(svg), format, std::forward<Args>(args)...);
}

std::string stroke_of(std::size_t i) {
  return fmt::format("stroke=\"{}\"", kColours[i % kColours.size()]);
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&': safe += "&amp;"; break;
      case '<': safe += "&lt;"; break;
      case '>': safe += "&gt;"; break;
      default:  // other control characters are none in XML
        safe += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
  }
  return safe;
}

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  bool known() const { return low <= high; }
  void include(const std::vector<double>& values) {
    for (const double value : values) {
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
};

/// The least of 1, 2, 5 times a power of ten that makes at most `most` steps over `range`.
double tick_step(double range, int most) {
  const double power = std::pow(10, std::floor(std::log10(range / most)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power * most >= range) return factor * power;
  }
  return 10 * power;
}

/// From values to places along one axis of the picture.
struct Scale {
  double low, high;  // values; of a logarithmic one their powers of ten
  double from, to;   // places
  bool is_logarithmic = false;

  double at(double value) const {
    const double v = is_logarithmic ? std::log10(std::max(value, std::pow(10, low))) : value;
    return from + (to - from) * (v - low) / (high - low);
  }
  /// Where its numbers stand, at most `most` of them.
  std::vector<double> ticks(int most) const {
    std::vector<double> values;
    if (is_logarithmic) {
      const int step = 1 + static_cast<int>(high - low - 1) / most;
      for (double power = high; power >= low; power -= step) values.push_back(std::pow(10, power));
      return values;
    }
    const double step = tick_step(high - low, most);
    const double last = std::floor(high / step * (1 + 1e-12));
    for (double k = std::ceil(low / step); k <= last; ++k) values.push_back(k * step + 0.0);
    return values;
  }
  std::string label(double value) const {
    if (!is_logarithmic) return fmt::format("{:.6g}", value);
    return fmt::format("10<tspan dy=\"-5\" font-size=\"10\">{:.0f}</tspan>", std::log10(value));
  }
};

/// `margin`: how much farther than its values an axis goes at either end, as a part of them.
Scale scale_of(const Axis& axis, const Range& range, double margin, double from, double to) {
  Scale scale{.low = 0, .high = 1, .from = from, .to = to, .is_logarithmic = axis.is_logarithmic};
  if (axis.is_logarithmic) {
    const double least = axis.min_span > 0 ? axis.min_span : std::numeric_limits<double>::min();
    scale.low = std::floor(std::log10(std::max(range.known() ? range.low : 1, least)));
    scale.high = std::max(std::ceil(std::log10(std::max(range.known() ? range.high : 1, least))),
                          scale.low + 1);
  } else if (range.known()) {
    const double middle = (range.low + range.high) / 2;
    double span = std::max(range.high - range.low, axis.min_span);
    // Of one value alone any span will do that the value is not lost in.
    if (span <= 1e-12 * std::abs(middle)) span = middle == 0 ? 1 : std::abs(middle);
    scale.low = middle - (0.5 + margin) * span;
    scale.high = middle + (0.5 + margin) * span;
  }
  return scale;
}

Range range_of(const Panel& panel) {
  Range range;
  for (const Curve& curve : panel.curves) range.include(curve.y);
  return range;
}

constexpr double kMargin = 0.05;  // beyond the values of an axis, as a part of them

/// What a panel of places shows from bottom to top.
double span_of(const Panel& panel) {
  const Range range = range_of(panel);
  return range.known() ? (1 + 2 * kMargin) * (range.high - range.low) : 0;
}

Scale x_scale(const Chart& chart) {
  Range range;
  for (const Panel& panel : chart.panels) {
    for (const Curve& curve : panel.curves) range.include(curve.x);
  }
  Scale x = scale_of(chart.x, range, chart.is_equal ? kMargin : 0, kLeft, kRight);
  if (!chart.is_equal) return x;
  double tallest = 0;
  for (const Panel& panel : chart.panels) tallest = std::max(tallest, span_of(panel));
  const double span = std::max(x.high - x.low, tallest * (kRight - kLeft) / kEqualHeight);
  const double middle = (x.low + x.high) / 2;
  x.low = middle - span / 2;
  x.high = middle + span / 2;
  return x;
}

void draw_values(const Scale& y, std::string& svg) {
  for (const double value : y.ticks(5)) {
    append(svg, "<path class=\"grid\" d=\"M{},{:.1f}H{}\"/>\n", kLeft, y.at(value), kRight);
    append(svg, "<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n", kLeft - 6,
           y.at(value) + 4, y.label(value));
  }
}

void draw_x(const Scale& x, double top, double bottom, std::string& svg) {
  for (const double value : x.ticks(10)) {
    append(svg, "<path class=\"grid\" d=\"M{:.1f},{:.1f}V{:.1f}\"/>\n", x.at(value), top, bottom);
    append(svg, "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n", x.at(value),
           bottom + 16, x.label(value));
  }
}

std::string path_of(const Curve& curve, bool is_dots, const Scale& x, const Scale& y) {
  std::string path;
  bool joined = false;
  for (std::size_t i = 0; i < std::min(curve.x.size(), curve.y.size()); ++i) {
    if (!std::isfinite(curve.x[i]) || !std::isfinite(curve.y[i])) {
      joined = false;
      continue;
    }
    append(path, "{}{:.1f},{:.1f}", joined ? 'L' : 'M', x.at(curve.x[i]), y.at(curve.y[i]));
    // A stroke without length, whose round ends are the dot.
    if (is_dots) path += "h0";
    joined = !is_dots;
  }
  return path;
}

void draw_panel(const Chart& chart, const Panel& panel, const Scale& x, const Scale& y,
                std::string& svg) {
  const double top = y.to, bottom = y.from;
  draw_x(x, top, bottom, svg);
  draw_values(y, svg);
  for (const Curve& curve : panel.curves) {
    const Line& line = chart.legend[curve.in_legend];
    append(svg, "<path class=\"{}\" {} d=\"{}\"><title>{}</title></path>\n",
           line.is_dots ? "dots" : "curve", line.stroke, path_of(curve, line.is_dots, x, y),
           escaped(line.name));
  }
  append(svg, "<rect class=\"frame\" x=\"{}\" y=\"{:.1f}\" width=\"{}\" height=\"{:.1f}\"/>\n",
         kLeft, top, kRight - kLeft, bottom - top);
  append(svg, "<text class=\"head\" x=\"{}\" y=\"{:.1f}\">{}</text>\n", kLeft, top - 7,
         escaped(panel.y.label));
}

/// In as many lines as it needs; returns where it ends.
double draw_legend(const std::vector<Line>& legend, std::string& svg) {
  constexpr double kSample = 26, kSpace = 18;
  double x = kLeft, y = kTitleHeight + kLegendLine / 2;
  for (const Line& line : legend) {
    const double width = kSample + 6 + kLetter * static_cast<double>(line.name.size());
    if (x > kLeft && x + width > kRight) {
      x = kLeft;
      y += kLegendLine;
    }
    if (line.is_dots) {
      append(svg, "<path class=\"dots\" {} d=\"M{:.1f},{:.1f}h0\"/>\n", line.stroke,
             x + kSample / 2, y - 4);
    } else {
      append(svg, "<path class=\"curve\" {} d=\"M{:.1f},{:.1f}h{}\"/>\n", line.stroke, x, y - 4,
             kSample);
    }
    append(svg, "<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x + kSample + 6, y,
           escaped(line.name));
    x += width + kSpace;
  }
  return y;
}

/// Of a panel whose scale is that of x.
double equal_height(const Panel& panel, const Scale& x) {
  const double per_unit = (x.to - x.from) / (x.high - x.low);
  return std::clamp(span_of(panel) * per_unit, 100.0, kEqualHeight);
}

}  // namespace

Line line_of(std::size_t i, std::string name) {
  return i < kColours.size() ? Line{std::move(name), stroke_of(i)}
                             : dashed_line(i, std::move(name));
}

Line dashed_line(std::size_t i, std::string name) {
  return {std::move(name), stroke_of(i) + " stroke-dasharray=\"7 3\""};
}

Line dots_of(std::size_t i, std::string name) {
  return {.name = std::move(name), .stroke = stroke_of(i), .is_dots = true};
}

Line black_line(std::string name) { return {std::move(name), "stroke=\"#000000\""}; }

std::string to_svg(const Chart& chart) {
  std::string drawn;
  const Scale x = x_scale(chart);
  double bottom = draw_legend(chart.legend, drawn);
  const double height = chart.panels.size() == 1 ? kOnlyPanelHeight : kPanelHeight;
  for (const Panel& panel : chart.panels) {
    const Range range = range_of(panel);
    if (!range.known()) continue;
    const double top = bottom + kPanelGap;
    bottom = top + (chart.is_equal ? equal_height(panel, x) : height);
    Scale y = scale_of(panel.y, range, kMargin, bottom, top);
    if (chart.is_equal) {
      const double half = 0.5 * (bottom - top) * (x.high - x.low) / (x.to - x.from);
      const double middle = (y.low + y.high) / 2;
      y.low = middle - half;
      y.high = middle + half;
    }
    draw_panel(chart, panel, x, y, drawn);
  }
  append(drawn, "<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n", kRight,
         bottom + kBottom + 4, escaped(chart.x.label));
  std::string svg;
  append(svg,
         "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1:.0f}\" width=\"{0}\" "
         "height=\"{1:.0f}\" font-family=\"sans-serif\" font-size=\"13\">\n"
         "<style>.grid{{stroke:#ddd}} .frame{{fill:none;stroke:#000}} "
         ".curve{{fill:none;stroke-width:1.6;stroke-linejoin:round}} "
         ".dots{{stroke-width:5;stroke-linecap:round}} .head{{font-size:14px}} "
         ".title{{font-size:17px}}</style>\n"
         "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
         "<text class=\"title\" x=\"{2}\" y=\"24\">{3}</text>\n",
         kWidth, bottom + kBottom + 14, kLeft, escaped(chart.title));
  return svg + drawn + "</svg>\n";
}

}  // namespace armature::plot
