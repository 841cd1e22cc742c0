// SPDX-License-Identifier: Apache-2.0
// 1. Pictures come at their own times after the start. 2. After the last one the file says what
// happens. 3. A picture that cannot be used ends the run with its name, or is left out and counted.
#include <gtest/gtest.h>

#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "picture_files_test.hpp"

namespace armature::camera::images {
namespace {

class ImagesTest : public testing::Test {
 protected:
  void write_pairs(int pairs) const {
    for (int i = 0; i < pairs; ++i) {
      const std::string name = std::to_string(i) + ".png";
      files_.write("left/" + name, 10 + i);
      files_.write("right/" + name, 100 + i);
    }
  }
  ComponentHarness::Options options(const std::string& more) const {
    return {.component = "{plugin: camera/images, params: {left: " + files_.path("left") +
                         ", right: " + files_.path("right") + ", rate_hz: 10" + more + "}}",
            .robot = {}};
  }
  /// Steps every 10 ms of [from, until) and gives "grey @ stamp in ms" of the left pictures.
  static std::vector<std::string> left(ComponentHarness& images, double from_s, double until_s) {
    std::vector<std::string> all;
    for (int i = 0; from_s + 0.01 * i < until_s - 1e-9; ++i) {
      images.step(from_s + 0.01 * i);
      for (const auto& image : images.take<msg::Image>("left_image")) {
        all.push_back(std::to_string(image.data_().front()) + " @ " +
                      std::to_string((stamp_of(image.header_().stamp_()) - Time{}) /
                                     std::chrono::milliseconds{1}));
      }
    }
    return all;
  }
  pictures::PictureFolder files_;
};

TEST_F(ImagesTest, PlaysBothCamerasAtTheirTimesAfterTheStart) {
  write_pairs(3);
  ComponentHarness images{built_plugins(), options(", start_s: 0.05")};
  EXPECT_EQ(left(images, 7.0, 8.0),
            (std::vector<std::string>{"10 @ 7050", "11 @ 7150", "12 @ 7250"}));
  const auto right = images.take<msg::Image>("right_image");
  ASSERT_EQ(right.size(), 3U);
  EXPECT_EQ(right[2].data_(), std::vector<std::uint8_t>(48, 102));
  EXPECT_EQ(right[2].header_().frame_id_(), "right_camera_optical");
  EXPECT_EQ(right[2].encoding_(), "mono8");
  EXPECT_EQ(right[2].width_(), 8U);
  EXPECT_EQ(right[2].height_(), 6U);
  EXPECT_EQ(right[2].step_(), 8U);
  EXPECT_EQ(stamp_of(right[2].header_().stamp_()), Time{} + seconds(7.25));
  EXPECT_FALSE(images.component().finished());
  EXPECT_EQ(images.lines().back(), "6 pictures were played");
  EXPECT_EQ(images.figures().metrics.at("pictures"), 6);
  EXPECT_EQ(images.figures().metrics.at("max_lateness_ms"), 0);
}

TEST_F(ImagesTest, BeginsAgainAfterTheLastPictureHasHadItsTime) {
  write_pairs(2);
  ComponentHarness images{built_plugins(), options(", at_end: loop")};
  EXPECT_EQ(left(images, 0, 0.5),
            (std::vector<std::string>{"10 @ 0", "11 @ 100", "10 @ 200", "11 @ 300", "10 @ 400"}));
}

TEST_F(ImagesTest, EndsTheRunAfterTheLastPictureHasHadItsTime) {
  write_pairs(2);
  ComponentHarness images{built_plugins(), options(", at_end: end_run")};
  left(images, 0, 0.2);
  EXPECT_FALSE(images.component().finished());
  left(images, 0.2, 0.21);
  EXPECT_TRUE(images.component().finished());
  EXPECT_EQ(images.figures().status, "");
}

TEST_F(ImagesTest, WhatCameLateIsCaughtUpAPairAStepAndTold) {
  write_pairs(4);
  ComponentHarness images{built_plugins(), options("")};
  images.step(0);
  images.step(0.25);
  EXPECT_EQ(images.take<msg::Image>("left_image").size(), 2U);
  images.step(0.251);
  EXPECT_EQ(images.take<msg::Image>("left_image").size(), 1U);
  EXPECT_NEAR(images.figures().metrics.at("max_lateness_ms"), 150, 1e-6);
}

TEST_F(ImagesTest, APictureThatCannotBeReadEndsTheRunWithItsName) {
  write_pairs(3);
  files_.write_text("right/1.png", "no PNG");
  ComponentHarness images{built_plugins(), options("")};
  EXPECT_EQ(left(images, 0, 1), (std::vector<std::string>{"10 @ 0", "11 @ 100"}));
  EXPECT_TRUE(images.component().finished());
  EXPECT_EQ(images.figures().status, "refused");
  EXPECT_EQ(
      images.figures().reason,
      files_.path("right/1.png") +
          ": it is none of PNG, JPEG, PGM, PPM, BMP and TIFF; bad_pictures: skip leaves such a "
          "picture out");
}

TEST_F(ImagesTest, AJpegThatIsCutOffEndsTheRunWithItsName) {
  for (const char* name : {"left/0.jpg", "right/0.jpg", "left/1.jpg", "right/1.jpg"}) {
    files_.write_stripes(name);
  }
  const std::string cut = files_.path("right/1.jpg");
  std::filesystem::resize_file(cut, std::filesystem::file_size(cut) / 3);
  ComponentHarness images{built_plugins(), options("")};
  images.step(0);
  images.step(0.1);
  EXPECT_TRUE(images.component().finished());
  EXPECT_EQ(images.figures().status, "refused");
  EXPECT_TRUE(images.figures().reason.starts_with(cut + ": a JPEG cannot be unpacked: "))
      << images.figures().reason;
}

TEST_F(ImagesTest, PicturesThatCannotBeUsedAreLeftOutNamedAndCounted) {
  write_pairs(4);
  files_.write_text("left/1.png", "no PNG");
  files_.write("left/2.png", 1, 9, 6);
  files_.write("left/alone.png", 1);
  ComponentHarness images{built_plugins(), options(", bad_pictures: skip")};
  EXPECT_EQ(left(images, 0, 1), (std::vector<std::string>{"10 @ 0", "13 @ 300"}));
  EXPECT_EQ(images.figures().metrics.at("pictures_skipped"), 3);
  EXPECT_EQ(images.figures().metrics.at("pictures"), 6);
  ASSERT_EQ(images.lines().size(), 4U);
  EXPECT_EQ(images.lines()[0],
            "left out: without a partner on the other side: " + files_.path("left/alone.png"));
  EXPECT_EQ(images.lines()[1], "left out: " + files_.path("left/1.png") +
                                   ": it is none of PNG, JPEG, PGM, PPM, BMP and TIFF");
  EXPECT_EQ(
      images.lines()[2],
      "left out: the left picture stamped 0.200000 s has 9 x 6 pixels, the first one has 8 x 6");
}

TEST_F(ImagesTest, AStepDoesNotReadAllPicturesThatCannotBeUsed) {
  files_.write("left/0.png", 1);
  files_.write("right/0.png", 1);
  for (int i = 1; i <= 50; ++i) {
    files_.write("left/" + std::to_string(i) + ".png", 1, 9, 6);
    files_.write("right/" + std::to_string(i) + ".png", 1, 9, 6);
  }
  ComponentHarness images{built_plugins(), options(", bad_pictures: skip")};
  images.step(0);
  images.step(0.001);
  EXPECT_LE(images.lines().size(), 10U);
  left(images, 0, 1);
  EXPECT_EQ(images.figures().metrics.at("pictures_skipped"), 100);
  EXPECT_EQ(images.lines().back(), "2 pictures were played");
}

TEST_F(ImagesTest, APictureWithoutAPartnerCountsOnceHoweverLongTheFirstThatCanBeUsedTakes) {
  for (int i = 0; i < 20; ++i) {
    files_.write_text("left/" + std::to_string(i) + ".png", "no PNG");
    files_.write_text("right/" + std::to_string(i) + ".png", "no PNG");
  }
  files_.write("left/20.png", 1);
  files_.write("right/20.png", 1);
  files_.write("left/alone.png", 1);
  ComponentHarness images{built_plugins(), options(", bad_pictures: skip")};
  left(images, 0, 1);
  EXPECT_EQ(images.figures().metrics.at("pictures_skipped"), 41);
}

TEST_F(ImagesTest, ARunWithoutAnyUsablePictureIsRefused) {
  files_.write_text("left/0.png", "no PNG");
  files_.write_text("right/0.png", "no PNG");
  ComponentHarness images{built_plugins(), options(", bad_pictures: skip, at_end: loop")};
  images.step(0);
  EXPECT_TRUE(images.component().finished());
  EXPECT_EQ(images.figures().reason, "there is no picture that can be used");
}

TEST_F(ImagesTest, WhatIsToBePlayedMustBeSaidOnceAndBeThere) {
  const auto refusal = [](const std::string& params) {
    return refusal_of(
        built_plugins(),
        {.component = "{plugin: camera/images, params: {" + params + "}}", .robot = {}});
  };
  EXPECT_NE(
      refusal("").find("there is nothing to play; set left and right (folders), or recording"),
      std::string::npos);
  EXPECT_NE(refusal("left: /gone, right: /gone").find("left: there is no folder '/gone'"),
            std::string::npos);
  EXPECT_NE(refusal("left: /gone, recording: /gone").find("both folders and a recording are given"),
            std::string::npos);
  EXPECT_NE(refusal("recording: /gone.mcap").find("recording: "), std::string::npos);
}

}  // namespace
}  // namespace armature::camera::images
