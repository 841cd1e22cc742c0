// SPDX-License-Identifier: Apache-2.0
#include "calibrated_pair.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "armature/messages/header.hpp"
#include "armature/runtime/plugins/setup_error.hpp"
#include "calibration_file.hpp"

namespace armature::camera::stereo_pair {
namespace {

constexpr double kMaxRelative = 0.01;  // of focal length and baseline, between rig and calibration
constexpr double kMaxPixels = 5;       // of the principal point

/// Where the rig that everybody else goes by says another pair than the calibration.
void check_rig(const StereoRig& rig, const StereoCamera& calibrated) {
  const StereoCamera& said = rig.camera;
  const auto differ = [](double a, double b) {
    return std::abs(a - b) > kMaxRelative * std::abs(b);
  };
  if (said.width == calibrated.width && said.height == calibrated.height &&
      !differ(said.focal_px, calibrated.focal_px) &&
      !differ(said.baseline_m, calibrated.baseline_m) &&
      std::abs(said.cx - calibrated.cx) <= kMaxPixels &&
      std::abs(said.cy - calibrated.cy) <= kMaxPixels) {
    return;
  }
  const auto lines = [](const StereoCamera& camera) {
    return fmt::format(
        "resolution: [{}, {}], focal_px: {:.3f}, principal_point_px: [{:.2f}, {:.2f}], "
        "baseline_mm: {:.3f}",
        camera.width, camera.height, camera.focal_px, camera.cx, camera.cy,
        1e3 * camera.baseline_m);
  };
  throw SetupError(
      fmt::format("the calibration gives another pair of cameras than the rig '{}'; write "
                  "into the rig {}, where it says {}",
                  rig.name, lines(calibrated), lines(said)));
}

stereo::StereoCalibration calibration_of(const Parameters& parameters,
                                         const std::optional<StereoRig>& rig) {
  const bool in_mm = parameters.calibration_unit == Parameters::CalibrationUnit::mm;
  const stereo::PictureSize of_rig =
      rig ? stereo::PictureSize{rig->camera.width, rig->camera.height} : stereo::PictureSize{};
  return stereo::read_stereo_calibration(parameters.calibration, parameters.right_calibration,
                                         in_mm ? 1e-3 : 1, of_rig);
}

}  // namespace

CalibratedPair::CalibratedPair(const Parameters& parameters, const std::optional<StereoRig>& rig) {
  if (parameters.calibration.empty()) {
    if (!rig) {
      throw SetupError(
          "neither a calibration nor a rig says what the cameras are; set calibration, "
          "or, when the pictures are rectified already, bind a rig");
    }
    rectification_.camera = rig->camera;
    return;
  }
  const stereo::StereoCalibration calibration = calibration_of(parameters, rig);
  const auto rectification = stereo::rectification_of(calibration);
  if (!rectification) {
    throw SetupError(
        fmt::format("calibration: {}: {}", parameters.calibration, rectification.error().text));
  }
  rectification_ = *rectification;
  if (rig) check_rig(*rig, rectification_.camera);
  maps_.emplace_back(rectification_.camera, rectification_.rectified_R_left, calibration.left);
  maps_.emplace_back(rectification_.camera, rectification_.rectified_R_right, calibration.right);
}

void CalibratedPair::rectify(Side side, const ImageView& raw,
                             std::vector<std::uint8_t>& pixels) const {
  if (!maps_.empty()) return maps_[static_cast<std::size_t>(side)].rectify(raw, pixels);
  pixels.clear();
  for (int v = 0; v < raw.height; ++v) {
    const std::uint8_t* row = raw.data + static_cast<std::size_t>(v) * raw.stride;
    pixels.insert(pixels.end(), row, row + raw.width);
  }
}

msg::CameraInfo CalibratedPair::info(Side side, Time stamp) const {
  const StereoCamera& c = camera();
  const double f = c.focal_px, p3 = side == Side::left ? 0 : -f * c.baseline_m;
  msg::CameraInfo info;
  write_header(info.header_(), stamp, kLeftCameraFrame);
  info.width_() = static_cast<std::uint32_t>(c.width);
  info.height_() = static_cast<std::uint32_t>(c.height);
  info.distortion_model_() = "plumb_bob";
  info.d_().assign(5, 0.0);
  info.k_() = {f, 0, c.cx, 0, f, c.cy, 0, 0, 1};
  info.r_() = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.p_() = {f, 0, c.cx, p3, 0, f, c.cy, 0, 0, 0, 1, 0};
  return info;
}

std::string CalibratedPair::description() const {
  const StereoCamera& c = camera();
  const std::string pair = fmt::format("{} x {} pixels, f {:.1f} px, baseline {:.2f} mm", c.width,
                                       c.height, c.focal_px, 1e3 * c.baseline_m);
  if (maps_.empty()) return pair + ", rectified already";
  const auto turned = [](const Eigen::Matrix3d& r) {
    return Eigen::AngleAxisd{r}.angle() * 180 / std::numbers::pi;
  };
  return fmt::format(
      "{}; the left camera is turned by {:.2f} degrees, the right one by {:.2f}; at "
      "least {:.1f} % of each picture is seen",
      pair, turned(rectification_.rectified_R_left), turned(rectification_.rectified_R_right),
      100 * std::min(maps_[0].coverage(), maps_[1].coverage()));
}

}  // namespace armature::camera::stereo_pair
