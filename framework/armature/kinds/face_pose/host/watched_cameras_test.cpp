// SPDX-License-Identifier: Apache-2.0
// What the host of the face pose estimators sees of the cameras: 1. frozen ones are refused until
// their own picture changes, 2. a still scene without noise, and what one camera alone sees, are no
// frozen camera, 3. rows that differ on average are told before any pair is refused.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "face_pose_host_bench_test.hpp"

namespace armature::face_pose_host {
namespace {

/// Pictures of 256 x 32 pixels with noise, or without.
class FacePoseHostAndCameras : public FacePoseHostTest {
 protected:
  static constexpr int kSeed = 5;

  FacePoseHostAndCameras() {
    msg::CameraInfo of_both = info();
    of_both.width_(256);
    of_both.height_(32);
    host_.send("right_info", of_both);
    take();
  }
  ~FacePoseHostAndCameras() override { FirstLandmark::rows.reset(); }

  /// The cameras take a new picture, or only one of them does. Without noise it is grey, with a
  /// thing at a column.
  void take(bool of_left = true, bool of_right = true, double noise = 2, int thing_at = 20) {
    std::normal_distribution<double> error{0, noise};
    for (auto& [picture, is_taken] : {std::pair{&left_, of_left}, {&right_, of_right}}) {
      if (!is_taken) continue;
      picture->width_(256);
      picture->height_(32);
      picture->step_(256);
      picture->encoding_("mono8");
      picture->data_().assign(256 * 32, 0);
      for (std::size_t i = 0; i < picture->data_().size(); ++i) {
        const bool shows_thing = std::abs(static_cast<int>(i % 256) - thing_at) < 8;
        picture->data_()[i] = static_cast<std::uint8_t>(
            std::lround((shows_thing ? 60 : 120) + (noise > 0 ? error(random_) : 0)));
      }
    }
  }
  /// What the host says of the pictures that are there, 0.1 s after the last ones.
  msg::FacePose look() {
    stamp_ += 0.1;
    for (auto* picture : {&left_, &right_}) picture->header_() = image(stamp_).header_();
    return see(left_, right_, landmarks(stamp_, 2));
  }
  void look_at_noise(int pairs) {
    for (int i = 0; i < pairs; ++i) {
      take();
      EXPECT_TRUE(look().valid_()) << "seed " << kSeed << ", pair " << i;
    }
  }

  msg::Image left_, right_;
  std::mt19937 random_{kSeed};
  double stamp_ = 0;
};

TEST_F(FacePoseHostAndCameras, OneThatIsFrozenIsRefusedAtOnceAndToldOfWhenItStays) {
  ASSERT_TRUE(look().valid_());
  take(false, true);
  EXPECT_EQ(look().reason_(),
            "the left camera is frozen: the same picture again, to the last bit, though the "
            "other camera's changes; look at its cable, and start its driver again");
  for (int repeat = 2; repeat <= 3; ++repeat) {
    EXPECT_EQ(host_.status().reason, "") << repeat;
    take(false, true);
    EXPECT_FALSE(look().valid_());
  }
  EXPECT_THAT(host_.status().reason,
              testing::StartsWith("the left camera is frozen: the same picture again"));
  take(true, true);
  EXPECT_TRUE(look().valid_());
  EXPECT_EQ(host_.status().reason, "");
  take(true, false);
  EXPECT_THAT(look().reason_(),
              testing::HasSubstr("the right camera is frozen: the same picture again"));
}

TEST_F(FacePoseHostAndCameras, BothFrozenIsSeenByTheNoiseThatIsNoMoreThere) {
  look_at_noise(4);
  EXPECT_THAT(look().reason_(),
              testing::HasSubstr("both cameras are frozen: the same picture again"));
  EXPECT_FALSE(look().valid_());
  take();
  EXPECT_TRUE(look().valid_());
}

TEST_F(FacePoseHostAndCameras, WhichCameraIsFrozenIsToldAnewWhenItIsAnotherOne) {
  look_at_noise(4);
  const auto stay = [&](bool of_left, bool of_right, const std::string& told) {
    for (int i = 0; i < 4; ++i) {
      take(of_left, of_right);
      EXPECT_FALSE(look().valid_()) << "seed " << kSeed << ", pair " << i;
    }
    EXPECT_THAT(host_.status().reason, testing::StartsWith(told));
  };
  stay(false, true, "the left camera is frozen: ");
  stay(false, false,
       "both cameras are frozen: the same picture again, to the last bit, though there was noise "
       "before in one, and that one changed while the other did not; ");
  stay(true, false, "the right camera is frozen: ");
}

TEST_F(FacePoseHostAndCameras, AStillSceneWithoutNoiseIsNotFrozen) {
  take(true, true, 0);
  for (int i = 0; i < 40; ++i) EXPECT_TRUE(look().valid_()) << i;
  // Something moves through it and comes to rest again, on a grey wall.
  for (int i = 0; i < 12; ++i) {
    take(true, true, 0, 20 + i);
    EXPECT_TRUE(look().valid_()) << i;
  }
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(look().valid_()) << i;
  // It moves by a column in the left picture only, as where an arm comes to rest.
  take(true, false, 0, 32);
  EXPECT_TRUE(look().valid_());
}

TEST_F(FacePoseHostAndCameras, OneThatIsFrozenStaysSoWhileThePatientRestsUntilItsPictureChanges) {
  for (const bool left_is_frozen : {true, false}) {
    const std::string who = left_is_frozen ? "the left camera" : "the right camera";
    take(true, true, 0, 100);
    EXPECT_TRUE(look().valid_()) << who;
    for (const int thing_at : {110, 120, 130, 130, 130, 130}) {
      take(!left_is_frozen, left_is_frozen, 0, thing_at);
      EXPECT_THAT(look().reason_(), testing::StartsWith(who + " is frozen")) << thing_at;
    }
    EXPECT_THAT(host_.status().reason, testing::StartsWith(who + " is frozen"));
    // It wakes up. What it shows has moved since long ago, which proves nothing of the other one.
    take(true, true, 0, 130);
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(look().valid_()) << who << ", " << i;
    EXPECT_EQ(host_.status().reason, "");
  }
}

TEST_F(FacePoseHostAndCameras, OneThatIsFrozenIsSeenByAFaceThatTakesASmallPartOfThePicture) {
  for (const bool left_is_frozen : {true, false}) {
    const int thing_at = left_is_frozen ? 128 : 144;
    take(true, true, 0, thing_at);
    EXPECT_TRUE(look().valid_());
    take(!left_is_frozen, left_is_frozen, 0, thing_at + 1);
    EXPECT_THAT(look().reason_(), testing::HasSubstr("camera is frozen"));
  }
}

TEST_F(FacePoseHostAndCameras, OneThatIsFrozenIsSeenByAFaceThatMovesSlowly) {
  take(true, true, 0, 128);
  EXPECT_TRUE(look().valid_());
  const auto fade_right = [&] {
    for (std::size_t i = 0; i < right_.data_().size(); ++i) {
      if (i % 256 > 124 && i % 256 < 132) right_.data_()[i] += 5;
    }
  };
  fade_right();
  EXPECT_TRUE(look().valid_());
  fade_right();
  EXPECT_TRUE(look().valid_());
  fade_right();
  EXPECT_THAT(look().reason_(), testing::StartsWith("the left camera is frozen"));
}

TEST_F(FacePoseHostAndCameras, WhatOneCameraAloneSeesAtTheRimOfItsPictureIsNoFrozenOne) {
  for (const bool is_left : {true, false}) {
    const int rim = is_left ? 0 : 192;
    take(true, true, 0, rim + 8);
    EXPECT_TRUE(look().valid_());
    for (int thing_at = rim + 8; thing_at <= rim + 56; thing_at += 8) {
      take(is_left, !is_left, 0, thing_at);
      EXPECT_TRUE(look().valid_()) << thing_at;
    }
  }
}

TEST_F(FacePoseHostAndCameras, RowsThatDifferOnAverageAreToldAndNoPairIsRefusedForThem) {
  const auto state_after = [&](const RowDifference& rows, int pairs) {
    FirstLandmark::rows = rows;
    look_at_noise(pairs);
    return host_.status().reason;
  };
  EXPECT_EQ(state_after({.at_face_px = 0.3}, 19), "");
  EXPECT_EQ(state_after({.at_face_px = 0.3}, 1),
            "the cameras are no longer well calibrated: on average the rows of their pictures "
            "differ by 0.30 px at the face (at most 0.15), and by 0.0 px more on one side of the "
            "picture than on the other (at most 1); calibrate them again with 'armature calibrate "
            "stereo', before faces are refused");
  EXPECT_EQ(state_after({}, 150), "");
  EXPECT_THAT(state_after({.by_column = 0.0075}, 60), testing::HasSubstr("by 1.0 px more on one"));
}

}  // namespace
}  // namespace armature::face_pose_host
