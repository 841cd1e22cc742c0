// SPDX-License-Identifier: Apache-2.0
#include "report_pictures.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "armature/values/temporary_folder.hpp"

namespace armature::report::lamp_alignment {
namespace {

class ReportPicturesTest : public testing::Test {
 protected:
  const TemporaryFolder folder_;
};

TEST_F(ReportPicturesTest, TheCameraPictureShowsLandmarksInGreen) {
  CameraPicture picture{.width = 64, .height = 48};
  picture.gray.assign(64 * 48, 100);
  picture.landmarks = {{20, 30}};
  picture.face =
      CameraPicture::FaceAxes{.mouth = {0, 0, 0.5}, .across = {1, 0, 0}, .normal = {0, 0, -1}};
  picture.focal_px = 50;
  write_camera_picture(picture, folder_ / "left_camera.png");
  const cv::Mat image = cv::imread((folder_ / "left_camera.png").string());
  ASSERT_EQ(image.cols, 64);
  ASSERT_EQ(image.rows, 48);
  EXPECT_EQ(image.at<cv::Vec3b>(30, 20), (cv::Vec3b{60, 220, 60}));
  EXPECT_EQ(image.at<cv::Vec3b>(40, 60), (cv::Vec3b{100, 100, 100}));
}

TEST_F(ReportPicturesTest, TheErrorPlotHasCurvesInBothPanels) {
  std::vector<LampError> errors;
  for (int k = 0; k <= 100; ++k) {
    errors.push_back({.time_s = 0.1 * k,
                      .distance_m = 0.6 - 0.001 * k,
                      .direction_error_rad = 1 - 0.01 * k,
                      .distance_error_m = 0.1 - 0.001 * k});
  }
  write_error_plot(errors, {}, folder_ / "errors.png");
  const cv::Mat image = cv::imread((folder_ / "errors.png").string());
  const auto curve_pixels = [&](int from_row, int to_row) {
    int count = 0;
    for (int v = from_row; v < to_row; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        count += image.at<cv::Vec3b>(v, u) == cv::Vec3b{180, 90, 20};
      }
    }
    return count;
  };
  EXPECT_GT(curve_pixels(0, 380), 500);
  EXPECT_GT(curve_pixels(380, 760), 500);
}

TEST_F(ReportPicturesTest, TheErrorPlotReachesFromTheGreatestErrorDown) {
  // 3 m and 120 degrees, then good: the curve begins below the upper edge of its panel.
  std::vector<LampError> errors{{.time_s = 0, .direction_error_rad = 2.1, .distance_error_m = 3},
                                {.time_s = 1, .direction_error_rad = 2.1, .distance_error_m = 3},
                                {.time_s = 2, .direction_error_rad = 0, .distance_error_m = 1e-9}};
  write_error_plot(errors, {}, folder_ / "errors.png");
  const cv::Mat image = cv::imread((folder_ / "errors.png").string());
  const auto first_row = [&](int from) {
    for (int v = from; v < image.rows; ++v) {
      if (image.at<cv::Vec3b>(v, 200) == cv::Vec3b{180, 90, 20}) return v;
    }
    return image.rows;
  };
  EXPECT_GT(first_row(0), 40 + 20);
  EXPECT_LT(first_row(0), 40 + 60);
  EXPECT_GT(first_row(380), 415 + 20);
  EXPECT_LT(first_row(380), 415 + 60);
}

TEST_F(ReportPicturesTest, ARunWithoutAnySampleStillHasAPlot) {
  write_error_plot({}, {}, folder_ / "errors.png");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "errors.png"));
}

TEST_F(ReportPicturesTest, AFolderThatIsNotThereIsNamed) {
  EXPECT_THROW(write_error_plot({}, {}, folder_ / "missing" / "errors.png"), std::runtime_error);
}

}  // namespace
}  // namespace armature::report::lamp_alignment
