// SPDX-License-Identifier: Apache-2.0
#include "operating_room.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <string>

#include "armature/kinds/geometry_params.hpp"

namespace armature::sim::optical_tracker {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

std::vector<Isometry3d> sites_of(const Parameters& parameters, const Params& params) {
  const auto positions = points_of(parameters.sites, params, "sites_mm", 1, "at least one site");
  const auto angles =
      points_of(parameters.sites_rpy, params, "sites_rpy_deg", 1, "at least one site");
  if (positions.size() != angles.size()) {
    params.refuse({"sites_mm", "sites_rpy_deg"},
                  fmt::format("'sites_mm' has {} sites, 'sites_rpy_deg' has {}", positions.size(),
                              angles.size()));
  }
  std::vector<Isometry3d> sites;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    sites.emplace_back(Eigen::Translation3d{positions[i]} *
                       Eigen::Quaterniond{rotation_from_rpy(angles[i])});
  }
  return sites;
}

/// What is wrong with an implant; empty: nothing. Where the bore ends above its bottom is judged by
/// the task, which knows how deep it is.
std::string defect_of(const PlannedImplant& implant) {
  constexpr double kMaxLength_m = 0.1, kMinPitch_m = 1e-4;
  if (!(implant.above_bottom_m <= kMaxLength_m)) {
    return fmt::format("its end above the bottom is {:g} mm, at most {:g} are wanted",
                       1e3 * implant.above_bottom_m, 1e3 * kMaxLength_m);
  }
  if (!(implant.length_m > 0 && implant.length_m <= kMaxLength_m)) {
    return fmt::format("its length is {:g} mm, more than 0 and at most {:g} are wanted",
                       1e3 * implant.length_m, 1e3 * kMaxLength_m);
  }
  if (!(implant.pitch_m >= kMinPitch_m && implant.pitch_m <= implant.length_m)) {
    return fmt::format("its pitch is {:g} mm, from {:g} to its length are wanted",
                       1e3 * implant.pitch_m, 1e3 * kMinPitch_m);
  }
  return "";
}

std::vector<PlannedImplant> implants_of(const Parameters& parameters, const Params& params,
                                        std::size_t sites) {
  if (parameters.implants.empty()) return {};
  std::vector<PlannedImplant> implants;
  for (const Vector3d& implant : points_of(parameters.implants, params, "implants_mm", 1,
                                           "above the bottom, length and pitch of each")) {
    implants.push_back(
        {.above_bottom_m = implant.x(), .length_m = implant.y(), .pitch_m = implant.z()});
    const std::string wrong = defect_of(implants.back());
    if (!wrong.empty()) {
      params.refuse({"implants_mm"},
                    fmt::format("'implants_mm': of implant {} {}", implants.size(), wrong));
    }
  }
  if (implants.size() != sites) {
    params.refuse({"implants_mm", "sites_mm"},
                  fmt::format("'implants_mm' has {} implants, 'sites_mm' has {} sites",
                              implants.size(), sites));
  }
  return implants;
}

}  // namespace

OperatingRoom operating_room(const Parameters& parameters, const Params& params,
                             const Isometry3d& flange_T_file_tool) {
  const Isometry3d flange_T_drill =
      flange_T_file_tool * Eigen::Translation3d{vector_of(parameters.drill_offset)};
  OperatingRoom room;
  room.chain.base_T_tracker = pose_of(parameters.tracker, parameters.tracker_rpy);
  room.chain.flange_T_body = pose_of(parameters.body, parameters.body_rpy);
  room.chain.tip = room.chain.flange_T_body.inverse() * flange_T_drill.translation();
  const Eigen::Translation3d driver_offset{vector_of(parameters.driver_offset)};
  room.driver_tip =
      room.chain.flange_T_body.inverse() * (flange_T_file_tool * driver_offset).translation();
  room.chain.flange_R_tool = flange_T_drill.linear();
  room.chain.tracker_T_patient =
      room.chain.base_T_tracker.inverse() * pose_of(parameters.jaw, parameters.jaw_rpy);
  room.chain.patient_T_image = pose_of(parameters.image, parameters.image_rpy);
  room.markers = points_of(parameters.markers, params, "markers_mm", 3, "at least three markers");
  room.sites = sites_of(parameters, params);
  room.implants = implants_of(parameters, params, room.sites.size());
  return room;
}

Isometry3d turned_about_tip(const Vector3d& tip, const Vector3d& tracker_divot, double cone_rad,
                            double elapsed_s) {
  // [1/s]: incommensurable, so that no orientation comes back soon.
  constexpr double kRound = 1.3, kTilt = 0.37, kTwist = 0.71, kTwistRad = 0.2;
  const double turn = 2 * M_PI * elapsed_s;
  const double tilt = cone_rad * (0.5 - 0.5 * std::cos(kTilt * turn));
  const Vector3d about{std::cos(kRound * turn), std::sin(kRound * turn), 0};
  const Eigen::Quaterniond rotation =
      Eigen::AngleAxisd{tilt, about} *
      Eigen::AngleAxisd{kTwistRad * std::sin(kTwist * turn), Vector3d::UnitZ()};
  return Eigen::Translation3d{tracker_divot} * rotation * Eigen::Translation3d{-tip};
}

}  // namespace armature::sim::optical_tracker
