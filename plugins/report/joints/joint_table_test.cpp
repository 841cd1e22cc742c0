// SPDX-License-Identifier: Apache-2.0
#include "joint_table.hpp"

#include <gtest/gtest.h>

#include <clocale>
#include <limits>
#include <locale>
#include <string>

namespace armature::report::joints {
namespace {

RobotModel arm_of(const std::string& first, const std::string& second) {
  Joint turns{.name = first, .type = Joint::Type::revolute};
  Joint slides{.name = second, .type = Joint::Type::prismatic};
  const NamedFrame tool{.name = "tool", .parent_joint = 1};
  return {{"two", RobotModel::Convention::standard, {turns, slides}, {tool}, FrameId{0}, {}, {}}};
}

JointVector two(double a, double b) { return Eigen::Vector2d{a, b}; }

TEST(JointTable, EveryColumnNamesItsUnit) {
  EXPECT_EQ(header_line(arm_of("j1", "needle")),
            "time_s,stamp_s,j1_rad,needle_m,j1_rad_s,needle_m_s,j1_reference_rad,"
            "needle_reference_m,j1_error_rad,needle_error_m,goal_id,goal_position_error_m,"
            "goal_orientation_error_rad\r\n");
}

TEST(JointTable, ANameThatHoldsACommaOrAQuoteIsOneField) {
  const std::string header = header_line(arm_of("left,\"2\"", "b"));
  EXPECT_NE(header.find(",\"left,\"\"2\"\"_rad\",b_m,"), std::string::npos) << header;
}

TEST(JointTable, ARowTellsTheErrorAsMeasuredMinusReference) {
  std::string text;
  append_line({.stamp = Time{1'700'000'001'250'000'007},
               .since_start = Duration{1'250'000'007},
               .position = two(0.5, 0.1),
               .speed = two(-1, 0),
               .reference = two(0.4, 0.125),
               .goal = JointRow::Goal{12, 0.001, 1e-7}},
              text);
  EXPECT_EQ(text,
            "1.250000,1700000001.250000007,0.5,0.1,-1,0,0.4,0.125,0.1,-0.025,12,0.001,1e-07\r\n");
}

TEST(JointTable, WhatNobodyToldAndWhatIsNoNumberAreEmptyFields) {
  std::string text;
  append_line(
      {.stamp = {}, .position = two(0.5, std::numeric_limits<double>::infinity()), .speed = {}},
      text);
  EXPECT_EQ(text, "0.000000,0.000000000,0.5,,,,,,,,,,\r\n");
}

TEST(JointTable, NothingIsLessThanZeroByItsSignOnly) {
  std::string text;
  append_line({.stamp = {}, .position = two(-0.0, 1), .speed = {}}, text);
  EXPECT_EQ(text.substr(0, 25), "0.000000,0.000000000,0,1,");
}

struct Comma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
};

TEST(JointTable, ADecimalSignIsAPointWhateverTheLocale) {
  const std::locale before = std::locale::global(std::locale{std::locale::classic(), new Comma});
  std::string text;
  append_line({.stamp = {}, .position = two(0.5, 0.25), .speed = {}}, text);
  std::locale::global(before);
  EXPECT_EQ(text.substr(0, 31), "0.000000,0.000000000,0.5,0.25,,");
}

}  // namespace
}  // namespace armature::report::joints
