// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/kinematics/frame_buffer.hpp"

#include <gtest/gtest.h>

#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/model/test_robots.hpp"

namespace armature {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

class FrameBufferOfTheLamp : public ::testing::Test {
 protected:
  /// Joints that move evenly: half way between two samples is half way between their values.
  JointVector joints(double t_ms) const {
    return JointVector::Constant(5, 0.1) + t_ms * JointVector::LinSpaced(5, 0.001, 0.005);
  }
  void add_ms(std::int64_t t) { buffer.add(Time{t * kMillisecond}, joints(double(t))); }

  const RobotModel lamp = testing::dental_lamp();
  FrameBuffer buffer{lamp, 8};
};

TEST_F(FrameBufferOfTheLamp, AnswersTheSamplesThemselves) {
  for (int t = 1000; t < 1080; t += 10) add_ms(t);
  for (int t = 1000; t < 1080; t += 10)
    EXPECT_TRUE(*buffer.joints_at(Time{t * kMillisecond}) == joints(t)) << t;
}

TEST_F(FrameBufferOfTheLamp, InterpolatesLinearlyBetweenSamples) {
  for (const int t : {1000, 1003, 1020, 1021, 1050}) add_ms(t);
  for (double t = 1000; t <= 1050; t += 0.25) {
    const Time time{static_cast<std::int64_t>(t * 1e6)};
    EXPECT_LT((*buffer.joints_at(time) - joints(t)).cwiseAbs().maxCoeff(), 1e-12) << t;
    EXPECT_LT(
        (buffer.base_T(lamp.tool(), time)->matrix() - forward_kinematics(lamp, joints(t)).matrix())
            .cwiseAbs()
            .maxCoeff(),
        1e-12);
  }
}

TEST_F(FrameBufferOfTheLamp, GoesOnForOneSampleAsItDid) {
  for (const int t : {1000, 1010, 1020}) add_ms(t);
  EXPECT_LT((*buffer.joints_at(Time{1030 * kMillisecond}) - joints(1030)).cwiseAbs().maxCoeff(),
            1e-12);
  EXPECT_FALSE(buffer.joints_at(Time{1031 * kMillisecond}));
}

TEST_F(FrameBufferOfTheLamp, KeepsTheNewestSamplesOnly) {
  for (int t = 0; t < 1000; t += 10) add_ms(t);
  EXPECT_EQ(buffer.newest(), Time{990 * kMillisecond});
  EXPECT_TRUE(buffer.joints_at(Time{920 * kMillisecond}));
  EXPECT_EQ(buffer.joints_at(Time{919 * kMillisecond}).error().text,
            "t = 0.919 s is 1.0 ms older than the history");
}

TEST_F(FrameBufferOfTheLamp, SaysByHowMuchAnInstantIsOutsideOfTheHistory) {
  add_ms(3400);
  add_ms(3490);
  add_ms(3500);
  EXPECT_EQ(buffer.joints_at(Time{3512 * kMillisecond}).error().text,
            "t = 3.512 s is 12.0 ms newer than the history");
  EXPECT_EQ(buffer.base_T(lamp.tool(), Time{3396 * kMillisecond + 500'000}).error().text,
            "t = 3.397 s is 3.5 ms older than the history");
}

TEST_F(FrameBufferOfTheLamp, TellsNothingOfAGapNorOfWhatFollowsItsFirstSample) {
  for (const int t : {1000, 1010, 3010}) add_ms(t);
  EXPECT_TRUE(*buffer.joints_at(Time{1010 * kMillisecond}) == joints(1010));
  EXPECT_TRUE(*buffer.joints_at(Time{3010 * kMillisecond}) == joints(3010));
  EXPECT_EQ(buffer.joints_at(Time{2000 * kMillisecond}).error().text,
            "the joint positions next to t = 2.000 s are 2.000 s apart");
  EXPECT_FALSE(buffer.joints_at(Time{3020 * kMillisecond}));
  add_ms(3020);
  EXPECT_TRUE(buffer.joints_at(Time{3030 * kMillisecond}));
}

TEST_F(FrameBufferOfTheLamp, AnswersForAnArmThatReportsTenTimesASecond) {
  for (const int t : {1000, 1100, 1200, 1310}) add_ms(t);
  for (const int t : {1050, 1260, 1400}) {
    EXPECT_LT((*buffer.joints_at(Time{t * kMillisecond}) - joints(t)).norm(), 1e-12) << t;
  }
}

TEST_F(FrameBufferOfTheLamp, DropsASampleWhoseStampLiesAheadOfThoseBehindIt) {
  for (const int t : {1000, 1010}) add_ms(t);
  buffer.add(Time{3'600'000 * kMillisecond}, joints(1015));
  for (int t = 1020; t < 1100; t += 10) add_ms(t);
  EXPECT_EQ(buffer.newest(), Time{1090 * kMillisecond});
  EXPECT_LT((*buffer.joints_at(Time{1035 * kMillisecond}) - joints(1035)).norm(), 1e-12);
}

TEST_F(FrameBufferOfTheLamp, RefusesWhileNothingHasArrived) {
  EXPECT_TRUE(buffer.empty());
  EXPECT_EQ(buffer.newest(), Time{});
  EXPECT_EQ(buffer.joints_at(Time{0}).error().text, "no joint positions have arrived yet");
}

TEST_F(FrameBufferOfTheLamp, IgnoresSamplesThatAreNotNewer) {
  add_ms(10);
  add_ms(20);
  buffer.add(Time{20 * kMillisecond}, joints(99));
  buffer.add(Time{15 * kMillisecond}, joints(99));
  EXPECT_TRUE(*buffer.joints_at(Time{20 * kMillisecond}) == joints(20));
  EXPECT_LT((*buffer.joints_at(Time{15 * kMillisecond}) - joints(15)).norm(), 1e-12);
}

}  // namespace
}  // namespace armature
