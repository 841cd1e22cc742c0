// SPDX-License-Identifier: Apache-2.0
#include "armature/plot/chart.hpp"

#include <gmock/gmock.h>
#include <tinyxml2.h>

#include <limits>
#include <set>

#include "tests/text.hpp"

namespace armature::plot {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kGap = std::numeric_limits<double>::quiet_NaN();

/// One panel with one curve.
Chart chart_of(std::vector<double> x, std::vector<double> y) {
  return {.title = "t",
          .legend = {line_of(0, "a")},
          .x = {.label = "time [s]"},
          .panels = {{.y = {.label = "p"}, .curves = {{0, std::move(x), std::move(y)}}}}};
}

/// The numbers of the path that bears this name.
std::vector<double> path_of(const std::string& svg, const std::string& name) {
  const auto paths = test::matches_of("d=\"([^\"]*)\"><title>" + name, svg);
  if (paths.empty()) return {};
  std::vector<double> numbers;
  for (const auto& number : test::matches_of("[-0-9.]+", paths.front()[1])) {
    numbers.push_back(std::stod(number.front()));
  }
  return numbers;
}

void expect_xml(const std::string& svg) {
  tinyxml2::XMLDocument document;
  EXPECT_EQ(document.Parse(svg.c_str()), tinyxml2::XML_SUCCESS) << document.ErrorStr();
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

TEST(Chart, IsXmlWithTitlesUnitsAndALegendWhateverTheNames) {
  Chart chart = chart_of({0, 1}, {0, 1});
  chart.title = "The joints of <a & \"b\">";
  chart.legend = {line_of(0, "j<1>"), line_of(1, "j&2")};
  chart.panels.push_back({.y = {.label = "speed [rad/s]"}, .curves = {{1, {0, 1}, {1, 2}}}});
  const std::string svg = to_svg(chart);
  expect_xml(svg);
  for (const char* part :
       {">p<", "speed [rad/s]", "time [s]", "j&lt;1&gt;", "j&amp;2", "The joints of &lt;a &amp;"}) {
    EXPECT_THAT(svg, HasSubstr(part));
  }
}

TEST(Chart, GreaterValuesStandHigherAndLaterOnesFartherToTheRight) {
  const auto way = path_of(to_svg(chart_of({0, 4}, {-2, 3})), "a");
  ASSERT_EQ(way.size(), 4u);
  EXPECT_LT(way[0], way[2]);
  EXPECT_GT(way[1], way[3]);
}

TEST(Chart, ALogarithmicAxisGivesEveryPowerOfTenTheSameRoom) {
  Chart chart = chart_of({1, 100, 10000}, {1, 1e-2, 1e-4});
  chart.x.is_logarithmic = chart.panels[0].y.is_logarithmic = true;
  const auto way = path_of(to_svg(chart), "a");
  ASSERT_EQ(way.size(), 6u);
  EXPECT_NEAR(way[3] - way[1], way[5] - way[3], 0.11) << "to a tenth of a unit of the picture";
  EXPECT_NEAR(way[2] - way[0], way[4] - way[2], 0.11);
  EXPECT_GT(way[3], way[1]);
}

TEST(Chart, OfPlacesHasBothAxesToOneScale) {
  Chart chart = chart_of({0, 2, 2, 0}, {0, 0, 1, 1});
  chart.is_equal = true;
  const auto way = path_of(to_svg(chart), "a");
  ASSERT_EQ(way.size(), 8u);
  EXPECT_NEAR(way[2] - way[0], 2 * (way[3] - way[5]), 0.3);
}

TEST(Chart, WhatIsMissingIsAGapAndAPanelWithoutAnyValueIsLeftOut) {
  Chart chart = chart_of({0, 1, 2, 3, 4}, {1, 2, kGap, 3, 4});
  chart.panels.push_back({.y = {.label = "second"}, .curves = {{0, {0, 1}, {kGap, kGap}}}});
  const std::string svg = to_svg(chart);
  EXPECT_THAT(svg, testing::ContainsRegex("d=\"M[-0-9.,]+L[-0-9.,]+M[-0-9.,]+L[-0-9.,]+\""));
  EXPECT_THAT(svg, HasSubstr(">p<"));
  EXPECT_THAT(svg, Not(HasSubstr(">second<")));
}

TEST(Chart, WithoutAValueOrWithOneAloneIsAPictureToo) {
  expect_xml(to_svg(chart_of({}, {})));
  expect_xml(to_svg(chart_of({1}, {0})));
  expect_xml(to_svg(chart_of({1e9}, {-1e9})));
  Chart logarithmic = chart_of({1}, {0});
  logarithmic.panels[0].y.is_logarithmic = true;
  expect_xml(to_svg(logarithmic));
}

TEST(Chart, DotsAreNotJoined) {
  Chart chart = chart_of({0, 1, 2}, {0, 1, 2});
  chart.legend = {dots_of(0, "a")};
  EXPECT_THAT(to_svg(chart), testing::ContainsRegex("d=\"M[-0-9.,]+h0M[-0-9.,]+h0M[-0-9.,]+h0\""));
}

TEST(Chart, FourteenCurvesAreFourteenStrokes) {
  Chart chart = chart_of({}, {});
  chart.legend.clear();
  for (std::size_t i = 0; i < 14; ++i) {
    chart.legend.push_back(line_of(i, "j" + std::to_string(i)));
    chart.panels[0].curves.push_back({i, {0, 1}, {1, 1}});
  }
  std::set<std::string> strokes;
  for (const auto& stroke : test::matches_of("stroke=\"#[^>]*? d=", to_svg(chart))) {
    strokes.insert(stroke.front());
  }
  EXPECT_EQ(strokes.size(), 14u);
}

}  // namespace
}  // namespace armature::plot
