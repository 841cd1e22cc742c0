// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::monitor::compressed_image {
namespace {

msg::Image grey_at(Time stamp) {
  msg::Image image;
  set_stamp(image.header_().stamp_(), stamp);
  image.header_().frame_id_("left_camera_optical");
  image.encoding_("mono8");
  image.width_(320);
  image.height_(240);
  image.step_(320);
  image.data_().assign(320 * 240, 100);
  return image;
}

class CompressedImageTest : public testing::Test {
 protected:
  std::vector<msg::CompressedImage> after(const msg::Image& image, double now_s) {
    component_.send("image", image);
    component_.step(now_s);
    return component_.take<msg::CompressedImage>("compressed");
  }
  ComponentHarness component_{
      built_plugins(),
      {.component = "{plugin: monitor/compressed_image, params: {rate_hz: 10}}", .robot = {}}};
};

TEST_F(CompressedImageTest, HasTheHeaderOfThePictureAndFewerBytes) {
  const Time stamp{1'234'567'890};
  const auto compressed = after(grey_at(stamp), 1.3);
  ASSERT_EQ(compressed.size(), 1U);
  EXPECT_EQ(stamp_of(compressed[0].header_().stamp_()), stamp);
  EXPECT_EQ(compressed[0].header_().frame_id_(), "left_camera_optical");
  EXPECT_EQ(compressed[0].format_(), "jpeg");
  ASSERT_GT(compressed[0].data_().size(), 4U);
  EXPECT_EQ(compressed[0].data_()[0], 0xFF);  // SOI of JPEG
  EXPECT_EQ(compressed[0].data_()[1], 0xD8);
  EXPECT_LT(compressed[0].data_().size(), 320 * 240 / 10);
}

TEST_F(CompressedImageTest, ComesAtMostAsOftenAsItIsAllowedTo) {
  std::size_t count = 0;
  for (int i = 0; i < 100; ++i) count += after(grey_at({}), 0.01 * i).size();
  EXPECT_NEAR(static_cast<double>(count), 10, 1);
}

TEST_F(CompressedImageTest, SaysWhatItCannotCompressAndGoesOn) {
  msg::Image wrong = grey_at({});
  wrong.encoding_("yuv422");
  EXPECT_TRUE(after(wrong, 0).empty());
  EXPECT_EQ(component_.status().state, StatusReporter::State::degraded);
  EXPECT_EQ(after(grey_at({}), 1).size(), 1U);
  EXPECT_EQ(component_.status().state, StatusReporter::State::ok);
}

}  // namespace
}  // namespace armature::monitor::compressed_image
