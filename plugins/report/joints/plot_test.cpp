// SPDX-License-Identifier: Apache-2.0
#include "plot.hpp"

#include <gmock/gmock.h>
#include <tinyxml2.h>

#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "tests/text.hpp"

namespace armature::report::joints {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kGap = std::numeric_limits<double>::quiet_NaN();

Panel panel(const std::string& title, std::size_t curve, bool is_logarithmic = false) {
  return {.title = title,
          .is_logarithmic = is_logarithmic,
          .min_span = is_logarithmic ? 1e-9 : 1e-3,
          .curves = {{curve, curve}}};
}

/// The numbers of the path that bears this title.
std::vector<double> path_of(const std::string& svg, const std::string& title) {
  const auto paths = test::matches_of("d=\"([^\"]*)\"><title>" + title, svg);
  if (paths.empty()) return {};
  std::vector<double> numbers;
  for (const auto& number : test::matches_of("[-0-9.]+", paths.front()[1])) {
    numbers.push_back(std::stod(number.front()));
  }
  return numbers;
}

TEST(ReportPlot, IsXmlWithTitlesUnitsAndALegendWhateverTheNames) {
  Envelope envelope{2};
  envelope.add(0, std::array{0.0, 1.0});
  envelope.add(1, std::array{1.0, 2.0});
  const std::string svg =
      to_svg("The joints of <a & \"b\">", {line_of(0, "j<1>"), line_of(1, "j&2")},
             {panel("position [rad]", 0), panel("speed [rad/s]", 1)}, envelope);
  tinyxml2::XMLDocument document;
  EXPECT_EQ(document.Parse(svg.c_str()), tinyxml2::XML_SUCCESS) << document.ErrorStr();
  for (const char* part : {"position [rad]", "speed [rad/s]", "time [s]", "j&lt;1&gt;", "j&amp;2",
                           "The joints of &lt;a &amp;"}) {
    EXPECT_THAT(svg, HasSubstr(part));
  }
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(ReportPlot, GreaterValuesStandHigherAndLaterOnesFartherToTheRight) {
  Envelope envelope{1};
  envelope.add(0, std::array{-2.0});
  envelope.add(4, std::array{3.0});
  const auto way = path_of(to_svg("t", {line_of(0, "j1")}, {panel("p", 0)}, envelope), "j1");
  ASSERT_EQ(way.size(), 4u);
  EXPECT_LT(way[0], way[2]);
  EXPECT_GT(way[1], way[3]);
}

TEST(ReportPlot, ACurveThatFallsFallsWithinEveryStretchToo) {
  Envelope envelope{1};
  for (int i = 0; i < 3000; ++i) envelope.add(i, std::array{-1.0 * i});
  ASSERT_GT(envelope.stretches().front().samples, 1u);
  const auto way = path_of(to_svg("t", {line_of(0, "j1")}, {panel("p", 0)}, envelope), "j1");
  ASSERT_GT(way.size(), 100u);
  // Of the first stretch nobody knows where the curve came from.
  for (std::size_t i = 7; i < way.size(); i += 2) EXPECT_GE(way[i], way[i - 2]) << i;
}

TEST(ReportPlot, ALogarithmicAxisGivesEveryPowerOfTenTheSameRoom) {
  Envelope envelope{1};
  for (int i = 0; i < 3; ++i) envelope.add(i, std::array{std::pow(10.0, -2 * i)});
  const auto way =
      path_of(to_svg("t", {black_line("tool")}, {panel("p", 0, true)}, envelope), "tool");
  ASSERT_EQ(way.size(), 6u);
  EXPECT_NEAR(way[3] - way[1], way[5] - way[3], 0.11) << "to a tenth of a unit of the picture";
  EXPECT_GT(way[3], way[1]);
}

TEST(ReportPlot, WhatIsMissingIsAGapAndAPanelWithoutAnyValueIsLeftOut) {
  Envelope envelope{2};
  for (const double value : {1.0, 2.0, kGap, 3.0, 4.0}) {
    envelope.add(static_cast<double>(envelope.stretches().size()), std::array{value, kGap});
  }
  const std::string svg = to_svg("t", {line_of(0, "a"), line_of(1, "b")},
                                 {panel("first", 0), panel("second", 1)}, envelope);
  EXPECT_THAT(svg, testing::ContainsRegex("d=\"M[-0-9.,]+L[-0-9.,]+M[-0-9.,]+L[-0-9.,]+\""));
  EXPECT_THAT(svg, HasSubstr(">first<"));
  EXPECT_THAT(svg, Not(HasSubstr(">second<")));
}

TEST(ReportPlot, ARunWithoutASampleIsAPictureToo) {
  tinyxml2::XMLDocument document;
  const std::string svg = to_svg("t", {line_of(0, "a")}, {panel("first", 0)}, Envelope{1});
  EXPECT_EQ(document.Parse(svg.c_str()), tinyxml2::XML_SUCCESS);
}

TEST(ReportPlot, FourteenCurvesAreFourteenStrokes) {
  Envelope envelope{14};
  envelope.add(0, std::vector<double>(14, 1.0));
  std::vector<Line> legend;
  Panel all = panel("p", 0);
  all.curves.clear();
  for (std::size_t i = 0; i < 14; ++i) {
    legend.push_back(line_of(i, "j" + std::to_string(i)));
    all.curves.push_back({i, i});
  }
  const std::string svg = to_svg("t", legend, {all}, envelope);
  std::set<std::string> strokes;
  for (const auto& stroke : test::matches_of("stroke=\"#[^>]*? d=", svg)) {
    strokes.insert(stroke.front());
  }
  EXPECT_EQ(strokes.size(), 14u);
}

}  // namespace
}  // namespace armature::report::joints
