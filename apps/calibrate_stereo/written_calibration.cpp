// SPDX-License-Identifier: Apache-2.0
#include "written_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "armature/config/document.hpp"

namespace armature {
namespace {

std::string matrix(const char* name, const Eigen::MatrixXd& m) {
  std::string data;
  for (Eigen::Index row = 0; row < m.rows(); ++row) {
    for (Eigen::Index column = 0; column < m.cols(); ++column) {
      data += fmt::format("{}{:.17g}", data.empty() ? "" : ", ", m(row, column));
    }
  }
  return fmt::format("{}: !!opencv-matrix\n   rows: {}\n   cols: {}\n   dt: d\n   data: [ {} ]\n",
                     name, m.rows(), m.cols(), data);
}

std::string lens_text(const char* camera, const char* distortion, const stereo::Lens& lens) {
  Eigen::Matrix3d k;
  k << lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1;
  const Eigen::MatrixXd d = Eigen::Map<const Eigen::Matrix<double, 1, 5>>{lens.distortion.data()};
  return matrix(camera, k) + matrix(distortion, d);
}

}  // namespace

std::string opencv_text(const stereo::StereoCalibration& calibration, const std::string& comment) {
  return fmt::format("%YAML:1.0\n---\n{}image_width: {}\nimage_height: {}\n", comment,
                     calibration.width, calibration.height) +
         lens_text("M1", "D1", calibration.left) + lens_text("M2", "D2", calibration.right) +
         matrix("R", calibration.right_T_left->linear()) +
         matrix("T", calibration.right_T_left->translation());
}

std::string mount_text(const std::string& rig_file) {
  if (std::filesystem::is_regular_file(rig_file)) {
    const config::Node rig = config::load(rig_file);
    if (const config::Node* mount = rig.find("mount")) {
      return config::to_yaml(config::Node::map({{"mount", {}, *mount}}, {}), false);
    }
  }
  return "# Where they hang is not in the pictures: say it, as of cameras in the middle of a "
         "tool.\n"
         "# mount: {frame: tool, center_mm: [0, 0, 0], forward: [1, 0, 0], right: [0, 0, 1]}\n";
}

std::string rig_text(const StereoCamera& camera, const std::string& calibration_file,
                     const std::string& mount) {
  return fmt::format(
      "# The cameras of {}, rectified.\n"
      "armature_rig: 1\n"
      "name: calibrated\n"
      "resolution: [{}, {}]\n"
      "focal_px: {:.6f}\n"
      "principal_point_px: [{:.6f}, {:.6f}]\n"
      "baseline_mm: {:.6f}\n"
      "{}",
      calibration_file, camera.width, camera.height, camera.focal_px, camera.cx, camera.cy,
      1e3 * camera.baseline_m, mount);
}

std::string coverage_svg(const std::vector<stereo::BoardView>& views, int width, int height) {
  constexpr int kGap = 20;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" width=\"1000\">\n"
      "<title>Corners in the pictures of the left and of the right camera</title>\n",
      2 * width + kGap, height);
  for (const auto& [side, shift] :
       {std::pair{&stereo::BoardView::left, 0}, {&stereo::BoardView::right, width + kGap}}) {
    svg += fmt::format(
        "<rect x=\"{}\" y=\"0\" width=\"{}\" height=\"{}\" fill=\"#f4f4f4\" stroke=\"#888\"/>\n",
        shift, width, height);
    for (const stereo::BoardView& view : views) {
      for (const Eigen::Vector2d& corner : view.*side) {
        svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"#0b62a4\"/>\n",
                           corner.x() + shift, corner.y());
      }
    }
  }
  return svg + "</svg>\n";
}

double coverage(const std::vector<stereo::BoardView>& views,
                std::vector<Eigen::Vector2d> stereo::BoardView::*side, int width, int height) {
  constexpr int kColumns = 8, kRows = 6;
  std::set<std::pair<int, int>> fields;
  for (const stereo::BoardView& view : views) {
    for (const Eigen::Vector2d& corner : view.*side) {
      fields.emplace(std::clamp(static_cast<int>(kColumns * corner.x() / width), 0, kColumns - 1),
                     std::clamp(static_cast<int>(kRows * corner.y() / height), 0, kRows - 1));
    }
  }
  return static_cast<double>(fields.size()) / (kColumns * kRows);
}

}  // namespace armature
