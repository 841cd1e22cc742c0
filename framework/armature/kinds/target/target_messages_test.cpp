// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/target/target_messages.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

using Eigen::Vector3d;

const TargetEstimate kEstimate{.stamp = Time{1'500'000'000},
                               .position = {1, 2, 3},
                               .normal = {0, 0.6, 0.8},
                               .velocity = {4, 5, 6},
                               .normal_rate = {7, 8, 9},
                               .measurements = 10};

msg::Target good() {
  msg::Target message;
  write_estimate(kEstimate, message);
  return message;
}

TEST(TargetMessages, AnEstimateIsReadAsItWasWritten) {
  const msg::Target message = good();
  EXPECT_EQ(message.header_().frame_id_(), "base");
  const auto read = estimate_of(message);
  ASSERT_TRUE(read) << read.error().text;
  EXPECT_EQ(read->stamp, kEstimate.stamp);
  EXPECT_EQ(read->position, kEstimate.position);
  EXPECT_EQ(read->normal, kEstimate.normal);
  EXPECT_EQ(read->velocity, kEstimate.velocity);
  EXPECT_EQ(read->normal_rate, kEstimate.normal_rate);
  EXPECT_EQ(read->measurements, 10);
}

TEST(TargetMessages, WhyThereIsNoneIsReadAsItWasWritten) {
  msg::Target message = good();
  write_no_estimate(Time{7}, Reason{"no face in the left image"}, message);
  EXPECT_EQ(stamp_of(message.header_().stamp_()), Time{7});
  EXPECT_EQ(to_eigen(message.position_()), Vector3d::Zero()) << "nothing of the one before";
  EXPECT_EQ(message.measurements_(), 0u);
  EXPECT_EQ(estimate_of(message).error().text, "no face in the left image");
}

TEST(TargetMessages, TheNormalIsMadeAUnit) {
  msg::Target message = good();
  assign(message.normal_(), Vector3d{0, 0, -2});
  EXPECT_EQ(estimate_of(message)->normal, -Vector3d::UnitZ());
}

TEST(TargetMessages, WhatIsNoTargetIsRefused) {
  const auto refusal = [](auto change) {
    msg::Target message = good();
    change(message);
    return estimate_of(message).error().text;
  };
  EXPECT_EQ(refusal([](auto& t) { t.position_().y_(NAN); }), "the target is not finite");
  EXPECT_EQ(refusal([](auto& t) { t.velocity_().y_(INFINITY); }), "the target is not finite");
  EXPECT_EQ(refusal([](auto& t) {
              assign(t.normal_(), Vector3d{0, 0, 0});
            }),
            "the target's normal has no direction");
  EXPECT_EQ(refusal([](auto& t) { t.header_().frame_id_() = "left_camera_optical"; }),
            "the target is stated in frame 'left_camera_optical', not in 'base'");
}

}  // namespace
}  // namespace armature
