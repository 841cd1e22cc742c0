// SPDX-License-Identifier: Apache-2.0
#include "calibration_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>

#include "armature/config/conversion.hpp"
#include "armature/config/document.hpp"
#include "armature/config/problems.hpp"
#include "armature/config/source_text.hpp"
#include "matrix_reader.hpp"

namespace armature::stereo {
namespace {

using config::Node;
using config::Problems;

/// OpenCV's dialect as YAML: its first line and its tags are blanked out, so that every place stays
/// where it is.
Node parse(const std::filesystem::path& file) {
  std::string text = config::read_source(file, {});
  if (text.starts_with("<?xml")) {
    throw config::ConfigError{{{.origin = {.file = file.string(), .line = 1, .column = 1},
                                .message = "is XML; have OpenCV write a name that ends in .yaml"}}};
  }
  if (text.starts_with('%')) text[0] = '#';
  constexpr std::string_view kTag = "!!opencv-matrix";
  for (auto at = text.find(kTag); at != std::string::npos; at = text.find(kTag, at)) {
    text.replace(at, kTag.size(), kTag.size(), ' ');
  }
  return config::parse_text(text, file.string());
}

/// What P1 and P2, or the two projection matrices of ROS, say.
struct Projections {
  std::string left_key, right_key;
  Eigen::MatrixXd left, right;
};

constexpr double kSamePixel = 1e-3;  // [px]

/// The pair with these projections; a problem where it is none whose rows agree.
void read_camera(const Projections& p, MatrixReader& left_file, MatrixReader& right_file,
                 double unit_m, Rectification& rectification) {
  const auto refuse = [&](const std::string& why) {
    right_file.problem(p.right_key, fmt::format("'{}' and '{}' are of no rectified pair: {}",
                                                p.left_key, p.right_key, why));
  };
  const auto differs = [](double a, double b) { return std::abs(a - b) > kSamePixel; };
  const double f = p.left(0, 0);
  if (!(f > 0)) {
    return left_file.problem(p.left_key,
                             fmt::format("'{}' has a focal length of {} px", p.left_key, f));
  }
  if (differs(f, p.left(1, 1)) || differs(f, p.right(0, 0)) || differs(f, p.right(1, 1))) {
    return refuse(fmt::format("the focal lengths {}, {}, {}, {} px differ", f, p.left(1, 1),
                              p.right(0, 0), p.right(1, 1)));
  }
  if (differs(p.left(1, 2), p.right(1, 2)) || p.right(1, 3) != 0) {
    return refuse("their rows do not agree; cameras one above the other are not read");
  }
  if (differs(p.left(0, 2), p.right(0, 2))) {
    return refuse(fmt::format("cx is {} and {} px; rectify with CALIB_ZERO_DISPARITY", p.left(0, 2),
                              p.right(0, 2)));
  }
  if (p.left(0, 3) != 0 || !(p.right(0, 3) < 0)) {
    return refuse(
        fmt::format("P[3] is {} on the left, where it must be 0, and {} on the right, where "
                    "it must be -f b; are left and right exchanged?",
                    p.left(0, 3), p.right(0, 3)));
  }
  rectification.camera.focal_px = f;
  rectification.camera.cx = p.left(0, 2);
  rectification.camera.cy = p.left(1, 2);
  rectification.camera.baseline_m = -p.right(0, 3) / f * unit_m;
}

/// The principal point of a lens that was calibrated at the size of the pictures is near their
/// middle.
void check_principal_point(const Lens& lens, const StereoCalibration& calibration,
                           MatrixReader& file, const std::string& key) {
  constexpr double kAside = 0.2;  // of a side
  const auto is_aside = [](double at, int size) { return !(std::abs(at / size - 0.5) < kAside); };
  const auto& [width, height] = std::pair{calibration.width, calibration.height};
  if (width == 0 || (!is_aside(lens.cx, width) && !is_aside(lens.cy, height))) return;
  file.problem(key,
               fmt::format("the principal point ({:g}, {:g}) of '{}' is far from the middle of "
                           "pictures of {} x {} pixels; was it calibrated at another size?",
                           lens.cx, lens.cy, key, width, height));
}

/// The names of OpenCV's two cameras, by its own samples or by its documentation.
std::string key_of(const MatrixReader& file, const std::string& short_name,
                   const std::string& long_name) {
  return file.has(long_name) && !file.has(short_name) ? long_name : short_name;
}

StereoCalibration read_opencv(const Node& root, double unit_m, const PictureSize& else_size,
                              Problems& problems) {
  MatrixReader file{root, problems};
  StereoCalibration calibration{.width = file.pixels("image_width"),
                                .height = file.pixels("image_height")};
  if (calibration.width == 0) {
    calibration.width = else_size.width;
    calibration.height = else_size.height;
  }
  for (const auto& [lens, number] :
       {std::pair{&calibration.left, "1"}, {&calibration.right, "2"}}) {
    const std::string camera =
        key_of(file, std::string{"M"} + number, std::string{"cameraMatrix"} + number);
    const std::string distortion =
        key_of(file, std::string{"D"} + number, std::string{"distCoeffs"} + number);
    *lens = file.lens(camera, distortion).value_or(Lens{});
    if (lens->fx > 0) check_principal_point(*lens, calibration, file, camera);
  }
  const auto r = file.rotation("R");
  const auto t = file.matrix("T", 3, 1);
  if (r && t) {
    calibration.right_T_left.emplace(Eigen::Isometry3d::Identity());
    calibration.right_T_left->linear() = *r;
    calibration.right_T_left->translation() = *t * unit_m;
  }
  if (file.has("R1") || file.has("R2") || file.has("P1") || file.has("P2")) {
    const auto r1 = file.rotation("R1"), r2 = file.rotation("R2");
    const auto p1 = file.matrix("P1", 3, 4), p2 = file.matrix("P2", 3, 4);
    if (!r1 || !r2 || !p1 || !p2) return calibration;
    calibration.rectification.emplace(
        Rectification{.camera = {}, .rectified_R_left = *r1, .rectified_R_right = *r2});
    read_camera({"P1", "P2", *p1, *p2}, file, file, unit_m, *calibration.rectification);
  }
  return calibration;
}

Lens read_ros_lens(MatrixReader& file, const Node& root, const StereoCalibration& calibration) {
  if (const Node* model = root.find("distortion_model")) {
    const std::string name = config::to_text(*model).value_or("");
    if (name != "plumb_bob" && name != "rational_polynomial") {
      file.problem("distortion_model",
                   fmt::format("the distortion model {} is not read; known are plumb_bob "
                               "and rational_polynomial",
                               model->describe()));
    }
  }
  const Lens lens = file.lens("camera_matrix", "distortion_coefficients").value_or(Lens{});
  if (lens.fx > 0) check_principal_point(lens, calibration, file, "camera_matrix");
  return lens;
}

StereoCalibration read_ros(const Node& left_root, const Node& right_root, double unit_m,
                           Problems& problems) {
  MatrixReader left{left_root, problems}, right{right_root, problems};
  StereoCalibration calibration{.width = left.pixels("image_width"),
                                .height = left.pixels("image_height")};
  const int width = right.pixels("image_width"), height = right.pixels("image_height");
  if (width != calibration.width || height != calibration.height) {
    right.problem("image_width",
                  fmt::format("the right pictures have {} x {} pixels, the left ones {} x {}",
                              width, height, calibration.width, calibration.height));
  }
  calibration.left = read_ros_lens(left, left_root, calibration);
  calibration.right = read_ros_lens(right, right_root, calibration);
  const auto r1 = left.rotation("rectification_matrix"),
             r2 = right.rotation("rectification_matrix");
  const auto p1 = left.matrix("projection_matrix", 3, 4),
             p2 = right.matrix("projection_matrix", 3, 4);
  if (!r1 || !r2 || !p1 || !p2) return calibration;
  calibration.rectification.emplace(
      Rectification{.camera = {}, .rectified_R_left = *r1, .rectified_R_right = *r2});
  read_camera({"projection_matrix", "projection_matrix", *p1, *p2}, left, right, unit_m,
              *calibration.rectification);
  return calibration;
}

}  // namespace

StereoCalibration read_stereo_calibration(const std::filesystem::path& file,
                                          const std::filesystem::path& right, double unit_m,
                                          const PictureSize& else_size) {
  const Node root = parse(file);
  const bool of_ros = root.find("camera_matrix") != nullptr;
  Problems problems;
  StereoCalibration calibration;
  if (of_ros && right.empty()) {
    problems.add(root.origin(),
                 "is of one camera; say the right one's file, too (right_calibration)");
  } else if (of_ros) {
    calibration = read_ros(root, parse(right), unit_m, problems);
  } else if (!right.empty()) {
    problems.add(
        root.origin(),
        "has no 'camera_matrix' and is not ROS' file of one camera; a file of both cameras "
        "needs no second one (right_calibration)");
  } else if (!root.find("M1") && !root.find("cameraMatrix1")) {
    problems.add(
        root.origin(),
        "is no calibration of two cameras: it has neither 'M1' (OpenCV) nor 'camera_matrix' "
        "(ROS, one file of each camera)");
  } else {
    calibration = read_opencv(root, unit_m, else_size, problems);
  }
  problems.throw_if_any();
  return calibration;
}

}  // namespace armature::stereo
