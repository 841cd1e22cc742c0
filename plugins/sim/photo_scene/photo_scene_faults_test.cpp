// SPDX-License-Identifier: Apache-2.0
// What cameras and rooms do wrong, on the scene's topics: 1. the right camera differs from the left
// one, 2. it is late, 3. pairs are dropped and repeated, 4. a camera freezes, 5. the light
// flickers; 6. round heads and their truth, 7. photos of one's own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "armature/kinds/target/target_messages.hpp"
#include "armature/values/temporary_folder.hpp"
#include "photo_scene_harness_test.hpp"

namespace armature::sim::photo_scene {
namespace {

using Eigen::Vector3d, testing::HasSubstr;

const std::string kStill = in_view("noise: 0, move_at_s: 1000");
const std::string kMoves = in_view("noise: 0, move_at_s: 0, move_mm: [0, 20, 50]");

std::string with(const std::string& params, const std::string& more) {
  return params + ", " + more;
}

bool same_picture(const msg::Image& a, const msg::Image& b) { return a.data_() == b.data_(); }

TEST(PhotoSceneFaults, OfTheRightCameraLeaveTheLeftPictureAndTheInfoAsTheyAre) {
  ScenePictures sound{kStill};
  const auto expected = sound.pair(1);
  const auto stated = sound.scene.take<msg::CameraInfo>("right_info").at(0);
  for (const char* fault : {"right_gain: 0.7", "right_roll_deg: 2", "right_shift_px: [0, 3]",
                            "right_focal_percent: 5"}) {
    SCOPED_TRACE(fault);
    ScenePictures scene{with(kStill, fault)};
    const auto pair = scene.pair(1);
    EXPECT_TRUE(same_picture(pair.left, expected.left));
    EXPECT_FALSE(same_picture(pair.right, expected.right));
    const auto told = scene.scene.take<msg::CameraInfo>("right_info");
    ASSERT_EQ(told.size(), 1U);
    EXPECT_EQ(told[0].p_(), stated.p_());
  }
  ScenePictures dim{with(kStill, "right_gain: 0.5")};
  EXPECT_NEAR(mean(dim.pair(1).right) / mean(expected.right), 0.5, 0.005);
}

TEST(PhotoSceneFaults, AShiftMovesTheRightPictureByWholeRows) {
  ScenePictures sound{with(kStill, "blur_px: 0")};
  ScenePictures shifted{with(kStill, "blur_px: 0, right_shift_px: [0, 4]")};
  const auto expected = sound.pair(1).right, seen = shifted.pair(1).right;
  const std::size_t rows = 4, width = 160;
  int unlike = 0;
  for (std::size_t i = rows * width; i < seen.data_().size(); ++i) {
    unlike += std::abs(seen.data_()[i] - expected.data_()[i - rows * width]) > 1;
  }
  EXPECT_EQ(unlike, 0);
}

TEST(PhotoSceneFaults, ALateRightCameraShowsWherePatientAndArmWere) {
  // The arm turns by 0.01 rad from picture to picture, the patient moves.
  ScenePictures sound{with(kMoves, "move_duration_s: 1")},
      late{with(kMoves, "move_duration_s: 1, right_delay_s: 0.2")};
  std::vector<ScenePictures::Pair> in_time, delayed;
  for (int i = 0; i <= 6; ++i) {
    in_time.push_back(sound.pair(0.1 * i, 0.01 * i));
    delayed.push_back(late.pair(0.1 * i, 0.01 * i));
  }
  for (std::size_t i = 2; i < delayed.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_TRUE(same_picture(delayed[i].left, in_time[i].left));
    EXPECT_TRUE(same_picture(delayed[i].right, in_time[i - 2].right));
    EXPECT_FALSE(same_picture(delayed[i].right, in_time[i].right));
    EXPECT_EQ(delayed[i].right.header_().stamp_(), delayed[i].left.header_().stamp_());
  }
}

TEST(PhotoSceneFaults, AFrozenCameraGivesItsLastPictureAgainWithNewStamps) {
  const auto is_frozen_of = [](const char* which) {
    ScenePictures scene{
        with(in_view("move_at_s: 1000"), std::string{"frozen_at_s: 0.25, frozen: "} + which)};
    std::vector<ScenePictures::Pair> pairs;
    for (int i = 0; i < 5; ++i) pairs.push_back(scene.pair(0.1 * i));
    EXPECT_FALSE(same_picture(pairs[1].left, pairs[2].left)) << "noise";
    for (std::size_t i : {3U, 4U}) {
      EXPECT_NE(pairs[i].left.header_().stamp_(), pairs[i - 1].left.header_().stamp_());
      EXPECT_EQ(same_picture(pairs[i].left, pairs[2].left),
                same_picture(pairs[3].left, pairs[2].left));
    }
    return std::pair{same_picture(pairs[3].left, pairs[2].left),
                     same_picture(pairs[3].right, pairs[2].right)};
  };
  EXPECT_EQ(is_frozen_of("none"), (std::pair{false, false}));
  EXPECT_EQ(is_frozen_of("left"), (std::pair{true, false}));
  EXPECT_EQ(is_frozen_of("right"), (std::pair{false, true}));
  EXPECT_EQ(is_frozen_of("both"), (std::pair{true, true}));
}

TEST(PhotoSceneFaults, DropsAndRepeatsAsManyPairsAsTold) {
  constexpr int kSteps = 400;
  ScenePictures scene{with(kMoves, "move_duration_s: 1000, dropped: 0.25, repeated: 0.2")};
  int dropped = 0, repeated = 0;
  std::vector<std::uint8_t> last;
  for (int i = 1; i <= kSteps; ++i) {
    const auto [left, right] = scene.step(i);
    ASSERT_EQ(left.size(), right.size()) << "both pictures of a pair, or none";
    dropped += left.empty();
    if (left.empty()) continue;
    EXPECT_EQ(stamp_of(left[0].header_().stamp_()), Time{} + seconds(i));
    repeated += left[0].data_() == last;
    last = left[0].data_();
  }
  // Four standard deviations of a binomial count.
  EXPECT_NEAR(dropped, 0.25 * kSteps, 4 * std::sqrt(kSteps * 0.25 * 0.75));
  EXPECT_NEAR(repeated, 0.2 * kSteps, 4 * std::sqrt(kSteps * 0.2 * 0.8));
}

TEST(PhotoSceneFaults, TheLightFlickersAsFastAndAsMuchAsTold) {
  ScenePictures scene{with(kStill, "flicker: 0.3, flicker_hz: 0.25, gain: 0.7")};
  const double usual = mean(scene.pair(1).left);  // the start: phase 0
  EXPECT_NEAR(mean(scene.pair(2).left) / usual, 1.3, 0.01);
  EXPECT_NEAR(mean(scene.pair(3).left) / usual, 1.0, 0.01);
  EXPECT_NEAR(mean(scene.pair(4).left) / usual, 0.7, 0.01);
}

TEST(PhotoSceneFaults, WhatIsStagedIsSeenInBothPictures) {
  ScenePictures plain{kStill};
  const auto expected = plain.pair(1);
  for (const char* staged :
       {"surface: cylinder", "surface: sphere", "occluder: instrument_over_mouth",
        "occluder: hand_over_mouth", "occluder: hand_over_eye", "occluder: mask",
        "second_face: true", "shadow: 0.5", "motion_px: [4, 0]", "face_seed: 5"}) {
    SCOPED_TRACE(staged);
    const auto pair = ScenePictures{with(kStill, staged)}.pair(1);
    EXPECT_FALSE(same_picture(pair.left, expected.left));
    EXPECT_FALSE(same_picture(pair.right, expected.right));
  }
}

TEST(PhotoSceneFaults, AnOccluderComesAndGoesWhenTold) {
  ScenePictures plain{kStill}, covered{with(kStill, "occluder: hand_over_mouth")},
      passing{with(kStill, "occluder: hand_over_mouth, occluder_at_s: 2, occluder_duration_s: 3")};
  for (int t = 0; t <= 7; ++t) {  // the scene starts with the first one
    SCOPED_TRACE(t);
    const auto without = plain.pair(t), with = covered.pair(t), seen = passing.pair(t);
    const bool is_there = t >= 2 && t < 5;
    EXPECT_TRUE(same_picture(seen.left, is_there ? with.left : without.left));
    EXPECT_TRUE(same_picture(seen.right, is_there ? with.right : without.right));
  }
}

TEST(PhotoSceneFaults, OfARoundHeadTheNormalOfThePaperIsToldWithItsRate) {
  ScenePictures scene{
      "surface: cylinder, radius_mm: 80, move_at_s: 0, move_duration_s: 4, move_tilt_up_deg: 20, "
      "move_tilt_side_deg: 40, tilt_side_deg: 10"};
  const auto told = [&](double t_s) {
    scene.scene.step(t_s);
    return estimate_of(scene.scene.take<msg::Target>("truth").at(0)).value();
  };
  const double depth = 0.08 * (1 - std::cos(0.0315 / 0.08));
  const Vector3d at_rest = told(0).normal;
  // The eyes stand back by `depth`, 65 mm above the mouth: the normal looks up by as much.
  EXPECT_NEAR(std::asin(at_rest.z()), std::atan2(depth, 0.065), 1e-9);
  constexpr double h = 1e-4;
  for (const double t : {1.0, 2.0, 3.5}) {
    const Vector3d before = told(t - h).normal;
    const auto now = told(t);
    const Vector3d after = told(t + h).normal;
    EXPECT_LT((now.normal_rate - (after - before) / (2 * h)).norm(), 1e-5);
    EXPECT_GT(now.normal_rate.norm(), 0.05);
  }
}

constexpr const char* kPortrait =
    "photo_file: /usr/lib/python3/dist-packages/imageio/resources/images/astronaut.png";

TEST(PhotoSceneFaults, AColourFileOfOnesOwnIsShownInGrey) {
  ScenePictures known{with(kStill, "photo: astronaut")};
  ScenePictures own{with(with(kStill, kPortrait),
                         "photo: file, photo_eyes_px: [203.6, 101.8, 246.9, 104.0], "
                         "photo_mouth_px: [223.1, 144.4]")};
  EXPECT_TRUE(same_picture(own.pair(1).left, known.pair(1).left));
}

TEST(PhotoSceneFaults, PhotosAndPartsThatCannotBeAreRefusedWithTheWayOut) {
  const auto refusal = [](const std::string& params) {
    return refusal_of(built_plugins(), scene_with(params));
  };
  EXPECT_EQ(refusal("photo: file"), "photo: file needs photo_file, the PNG or JPEG that it is");
  EXPECT_EQ(refusal("photo: file, photo_file: /no/such.png, photo_eyes_px: [1, 1, 9, 1], "
                    "photo_mouth_px: [5, 9]"),
            "cannot open the photo /no/such.png: No such file or directory");
  EXPECT_THAT(refusal(with(kPortrait, "photo: file")),
              HasSubstr("the left eye is at column 0 and the right one at 0"));
  EXPECT_THAT(refusal(with(kPortrait,
                           "photo: file, photo_eyes_px: [203, 101, 246, 104], photo_mouth_px: "
                           "[223, 1440]")),
              HasSubstr("(223, 1440) is not on"));
  EXPECT_THAT(refusal(with(kPortrait,
                           "photo: file, photo_eyes_px: [203, 101, 246, 104], photo_mouth_px: "
                           "[223, 90]")),
              HasSubstr("the mouth is below the eyes"));
  EXPECT_EQ(refusal("surface: sphere, radius_mm: 50, eye_distance_mm: 126"),
            "radius_mm: 50 bends the photo so far that its eyes leave the front of the head; at "
            "least 100 is needed");
  EXPECT_EQ(refusal("surface: cylinder, radius_mm: 50, eye_distance_mm: 126"), "");
  EXPECT_THAT(refusal("motion_px: [1e9, 0]"), HasSubstr("must be from -200 to 200"));
  EXPECT_EQ(refusal("dropped: 0.7, repeated: 0.6"),
            "dropped and repeated are parts of all pairs, and 0.7 + 0.6 is more than 1");
}

TEST(PhotoSceneFaults, APhotoThatIsCutOffIsRefused) {
  const TemporaryFolder folder;
  const std::string file = folder / "photo.jpg";
  const auto refusal = [&] {
    return refusal_of(built_plugins(),
                      scene_with("photo: file, photo_file: " + file +
                                 ", photo_eyes_px: [50, 40, 90, 40], photo_mouth_px: [70, 90]"));
  };
  cv::Mat stripes(120, 160, CV_8UC3);
  for (int v = 0; v < stripes.rows; ++v) stripes.row(v).setTo(cv::Scalar::all(97 * v % 256));
  ASSERT_TRUE(cv::imwrite(file, stripes));
  EXPECT_EQ(refusal(), "");
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 3);
  EXPECT_THAT(refusal(), HasSubstr(file + " is not an image that can be read: a JPEG cannot be "
                                          "unpacked: "));
}

TEST(PhotoSceneFaults, APhotoThatIsAFolderOrHasTooManyPixelsIsRefusedByItsName) {
  const auto refusal = [](const std::string& file) {
    return refusal_of(built_plugins(),
                      scene_with("photo: file, photo_file: " + file +
                                 ", photo_eyes_px: [50, 40, 90, 40], photo_mouth_px: [70, 90]"));
  };
  const TemporaryFolder folder;
  const std::string file = folder / "photo.pgm";
  EXPECT_EQ(refusal("/usr"), "/usr is no file; a photo is a PNG or JPEG");
  std::ofstream{file} << "P5 16000 16000 255\n";
  EXPECT_EQ(refusal(file), file +
                               " is not an image that can be read: it has 16000 x 16000 pixels; a "
                               "picture may have 100 million");
  std::filesystem::resize_file(file, std::uintmax_t{20} << 30);  // a hole: it takes no room
  EXPECT_EQ(refusal(file), "cannot open the photo " + file +
                               ": it has 21474836480 bytes; at most 420000000 are read");
}

}  // namespace
}  // namespace armature::sim::photo_scene
