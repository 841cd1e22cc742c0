// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "armature/values/temporary_folder.hpp"

// Pictures in files, for the tests.
namespace armature::pictures {

/// A folder of this test, gone with it.
class PictureFolder {
 public:
  std::string path(const std::string& name = "") const { return (folder_ / name).string(); }
  /// All pixels are `grey`.
  void write(const std::string& name, int grey, int width = 8, int height = 6) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    ASSERT_TRUE(cv::imwrite(path(name), cv::Mat{height, width, CV_8UC1, cv::Scalar::all(grey)}));
  }
  /// A coloured picture of 160 x 120 pixels that does not compress to nothing.
  void write_stripes(const std::string& name) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    cv::Mat picture(120, 160, CV_8UC3);
    for (int v = 0; v < picture.rows; ++v) {
      for (int u = 0; u < picture.cols; ++u) {
        picture.at<cv::Vec3b>(v, u) = {static_cast<std::uint8_t>(7 * u * v), 90,
                                       static_cast<std::uint8_t>(13 * u)};
      }
    }
    ASSERT_TRUE(cv::imwrite(path(name), picture));
  }
  void write_text(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream{folder_ / name} << text;
  }

 private:
  const TemporaryFolder folder_;
};

}  // namespace armature::pictures
