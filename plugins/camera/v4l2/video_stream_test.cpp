// SPDX-License-Identifier: Apache-2.0
// 1. A camera is set as it is asked for. 2. What it has not is refused, with what it has, and it is
// closed then.
#include "video_stream.hpp"

#include <gtest/gtest.h>

#include "fake_camera_test.hpp"

namespace armature::camera::v4l2 {
namespace {

class VideoStreamTest : public testing::Test {
 protected:
  std::string refusal() {
    VideoStream stream{camera_, settings_};
    const auto opened = stream.open();
    EXPECT_EQ(camera_.is_open, opened.has_value());
    return opened ? "" : opened.error().text;
  }
  FakeCamera camera_;
  StreamSettings settings_{.device = "/dev/video7", .width = 4, .height = 2};
};

TEST_F(VideoStreamTest, TakesTheFirstFormatThatItCanReadAndGivesTheKernelFourBuffers) {
  camera_.formats = {V4L2_PIX_FMT_H264, V4L2_PIX_FMT_MJPEG, V4L2_PIX_FMT_YUYV};
  camera_.padding = 6;
  VideoStream stream{camera_, settings_};
  ASSERT_TRUE(stream.open());
  EXPECT_EQ(stream.layout(), Layout::yuyv);
  EXPECT_EQ(stream.stride(), 14U);
  EXPECT_EQ(camera_.queued(), 4U);
  EXPECT_EQ(camera_.starts, 1);
  settings_.layout = Layout::mjpeg;
  VideoStream packed{camera_, settings_};
  stream.close();
  ASSERT_TRUE(packed.open());
  EXPECT_EQ(packed.layout(), Layout::mjpeg);
}

TEST_F(VideoStreamTest, NamesWhatCannotBeOpenedAndWhatMayHelp) {
  camera_.open_errors = {ENOENT, EACCES, EBUSY};
  EXPECT_EQ(refusal(), "cannot open /dev/video7: No such file or directory; is it plugged in?");
  EXPECT_EQ(refusal(),
            "cannot open /dev/video7: Permission denied; its user must be in the group 'video'");
  EXPECT_EQ(refusal(), "cannot open /dev/video7: Device or resource busy; another program has it");
}

TEST_F(VideoStreamTest, RefusesADeviceThatTakesNoPictures) {
  camera_.capabilities = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  EXPECT_EQ(refusal(),
            "/dev/video7 (Fake) takes no pictures; a camera often has several devices, of which "
            "the first "
            "is the one");
  camera_.capabilities = V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_STREAMING;
  EXPECT_EQ(
      refusal(),
      "/dev/video7 (Fake) takes no pictures in one plane; those of several planes are not read");
  camera_.capabilities = V4L2_CAP_VIDEO_CAPTURE;
  EXPECT_EQ(refusal(), "/dev/video7 (Fake) has no streaming input and output");
}

TEST_F(VideoStreamTest, RefusesAnotherFormatOrSizeThanIsAskedForAndSaysWhatThereIs) {
  camera_.sizes = {{640, 480}, {1280, 720}};
  EXPECT_EQ(
      refusal(),
      "/dev/video7 (Fake) gives 640 x 480 pixels of GREY instead of 4 x 2 of GREY; it offers 640 x "
      "480, 1280 x 720");
  settings_.layout = Layout::mjpeg;
  EXPECT_EQ(refusal(), "/dev/video7 (Fake) has not the format that is asked for; it offers GREY");
}

TEST_F(VideoStreamTest, RefusesAnotherRateThanIsAskedFor) {
  settings_.rate = 60;
  EXPECT_EQ(refusal(),
            "/dev/video7 (Fake) has one rate only, which cannot be set; leave rate_hz out");
  camera_.rate = 30;
  EXPECT_EQ(
      refusal(),
      "/dev/video7 (Fake) takes 30 pictures a second at 4 x 2 instead of 60; set rate_hz: 30");
  settings_.rate = 30;
  EXPECT_EQ(refusal(), "");
}

TEST_F(VideoStreamTest, TakesTheFirstFormatThatTheCameraHasAtTheRate) {
  camera_.formats = {V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_MJPEG};
  camera_.rates = {{V4L2_PIX_FMT_YUYV, 10}, {V4L2_PIX_FMT_MJPEG, 30}};
  settings_.rate = 30;
  VideoStream stream{camera_, settings_};
  const auto opened = stream.open();
  ASSERT_TRUE(opened) << opened.error().text;
  EXPECT_EQ(stream.layout(), Layout::mjpeg);
}

TEST_F(VideoStreamTest, SetsExposureAndGainOrSaysWhatTheCameraTakes) {
  settings_.exposure = 0.008;
  settings_.gain = 12;
  EXPECT_EQ(refusal(), "/dev/video7 (Fake) lets nobody set it; leave exposure_ms out");
  camera_.controls = {{V4L2_CID_EXPOSURE_AUTO, {0, 3}}, {V4L2_CID_EXPOSURE_ABSOLUTE, {100, 5000}}};
  EXPECT_EQ(refusal(), "/dev/video7 (Fake) takes a exposure_ms from 10 to 500, not 8");
  settings_.exposure = 0.02;
  EXPECT_EQ(refusal(), "/dev/video7 (Fake) lets nobody set it; leave gain out");
  camera_.controls[V4L2_CID_GAIN] = {0, 10};
  camera_.controls[V4L2_CID_AUTOGAIN] = {0, 1};
  EXPECT_EQ(refusal(), "/dev/video7 (Fake) takes a gain from 0 to 10, not 12");
  settings_.gain = 7;
  EXPECT_EQ(refusal(), "");
  EXPECT_EQ(camera_.set[V4L2_CID_EXPOSURE_AUTO], V4L2_EXPOSURE_MANUAL);
  EXPECT_EQ(camera_.set[V4L2_CID_EXPOSURE_ABSOLUTE], 200) << "steps of 0.1 ms";
  EXPECT_EQ(camera_.set[V4L2_CID_GAIN], 7);
  EXPECT_EQ(camera_.set[V4L2_CID_AUTOGAIN], 0);
}

TEST_F(VideoStreamTest, LeavesTheExposureToTheCameraWhereNoneIsAskedFor) {
  camera_.controls = {{V4L2_CID_EXPOSURE_AUTO, {0, 3}}};
  EXPECT_EQ(refusal(), "");
  EXPECT_EQ(camera_.set[V4L2_CID_EXPOSURE_AUTO], V4L2_EXPOSURE_APERTURE_PRIORITY);
}

TEST_F(VideoStreamTest, TellsABusThatHasNoRoomForMorePictures) {
  camera_.start_error = ENOSPC;
  EXPECT_EQ(refusal(),
            "/dev/video7 (Fake) does not start: No space left on device; its USB bus has no room "
            "for more "
            "pictures: take another port, mjpeg, or fewer pictures");
}

}  // namespace
}  // namespace armature::camera::v4l2
