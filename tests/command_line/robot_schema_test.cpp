// SPDX-License-Identifier: Apache-2.0
// `armature schema robot` and `armature schema rig`.
#include "judged_by_schema.hpp"

namespace armature::test {
namespace {

struct RobotSchema : JudgedBySchema {
  RobotSchema() : JudgedBySchema{"robot"} {}
};
struct RigSchema : JudgedBySchema {
  RigSchema() : JudgedBySchema{"rig"} {}
};

TEST_F(RobotSchema, FitsEveryRobotThatIsShipped) { expect_fits_all_in("configs/robots", 6); }

TEST_F(RigSchema, FitsEveryRigThatIsShipped) { expect_fits_all_in("configs/rigs", 2); }

TEST_F(RobotSchema, RefusesMisspeltKeysWrongTypesAndNumbersOutOfRange) {
  const std::string head = "armature_robot: 1\nname: r\n", joint = head + "joints: [{name: a, ";
  expect_refused({
      {head + "convetion: standard", "convetion"},
      {head + "convention: craig", "convention: "},
      {"armature_robot: 2\nname: r\n", "armature_robot: 2"},
      {head + "joints: {a: 1}", "joints: "},
      {joint + "limit_deg: [0, 1]}]", "limit_deg"},
      {joint + "limits_deg: [0]}]", "joints.0.limits_deg: "},
      {joint + "limits_deg: [0, far]}]", "joints.0.limits_deg.1: "},
      {joint + "limits_m: [0, 1]}]", "limits_m"},
      {joint + "type: prismatic, limits_deg: [0, 1]}]", "limits_deg"},
      {joint + "type: sliding}]", "joints.0.type: "},
      {joint + "velocity_rad_s: 0}]", "joints.0.velocity_rad_s: 0"},
      {joint + "d_cm: 1}]", "d_cm"},
      {joint + "d_m: long}]", "joints.0.d_m: "},
      {joint + "coupled: {to: b, factor: 2}}]", "factor"},
      {joint + "coupled: {to: b, offset_m: 2}}]", "offset_m"},
      {head + "frames: {tool: {parnt: a}}", "parnt"},
      {head + "frames: {tool: {parent: a, rpy_deg: [1, 2]}}", "frames.tool.rpy_deg: "},
      {head + "pointing_axis: w", "pointing_axis: "},
      {head + "pointing_axis: [0, 1]", "pointing_axis: "},
      {head + "shaft: {axis: w, length_mm: 280}", "shaft.axis: "},
      {head + "capsules: {arm: {parent: a, from_m: [0, 0], to_m: [0, 0, 1], radius_m: 1}}",
       "capsules.arm.from_m: "},
      {head + "home_deg: [a]", "home_deg.0: "},
      {head + "tip: tool0", "tip"},
      {head + "urdf: a.urdf\nconvention: standard", "convention"},
      {head + "urdf: a.urdf\njoints: [{name: a, alpha_deg: 90}]", "alpha_deg"},
  });
}

TEST_F(RobotSchema, TakesWhatReadingTakes) {
  EXPECT_EQ(judged_text("armature_robot: 1\nname: r\njoints:\n"
                        "  - {name: a, type: prismatic, d_mm: 120, limits_mm: [0, 250],\n"
                        "     velocity_m_s: 0.1, acceleration_m_s2: 0.5}\n"
                        "  - {name: b, type: prismatic, coupled: {to: a, offset_mm: 5}}\n"
                        "frames: {tool: {parent: b, translation_mm: [0, 0, 1]},\n"
                        "         body: {parent: b, calibrated: found.yaml}}\n"
                        "capsules: {arm: {parent: b, from_mm: [0, 0, 0], to_m: [0, 0, 1], "
                        "radius_mm: 80}}\n"
                        "pointing_axis: [0, 0, -2]\nhome: [0.1, 0.1]\n"),
            "");
  EXPECT_EQ(judged_text("armature_robot: 1\nname: r\nurdf: a.urdf\nbase: foot\ntip: tool0\n"
                        "joints: [{name: a, limits_m: [0, 1]}, {name: b, limits_deg: [0, 9]}]\n"),
            "");
  EXPECT_EQ(judged_text("include: arm.yaml\ntip: tool1\nhome_deg: null\n"
                        "joints: [{name: a, acceleration_m_s2: 1}]\n"),
            "")
      << "the file that it stands on may be one with a URDF file";
}

TEST_F(RigSchema, RefusesMisspeltKeysWrongTypesAndNumbersOutOfRange) {
  const std::string head = "armature_rig: 1\nname: r\n";
  expect_refused({
      {head + "resolutoin: [1280, 720]", "resolutoin"},
      {head + "resolution: [1280]", "resolution: "},
      {head + "resolution: [0, 720]", "resolution.0: 0"},
      {head + "fov_deg: 180", "fov_deg: 180"},
      {head + "focal_px: 0", "focal_px: 0"},
      {head + "baseline_m: wide", "baseline_m: "},
      {head + "mount: {frame: tool, centre_mm: [0, 0, 0]}", "centre_mm"},
      {head + "mount: {forward: [1, 0]}", "mount.forward: "},
  });
}

TEST_F(RigSchema, HasTheDocTheLimitsAndTheUnitsOfAKey) {
  const auto& baseline = schema_["properties"]["baseline_m"];
  EXPECT_EQ(baseline["exclusiveMinimum"], 0);
  EXPECT_EQ(baseline["description"], "From the left camera to the right one.");
  EXPECT_EQ(schema_["properties"]["baseline_mm"], baseline);
}

}  // namespace
}  // namespace armature::test
