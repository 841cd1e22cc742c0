// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/robot_keys.hpp"

#include "armature/config/key_rows.hpp"

namespace armature {
namespace {

using config::KeySpec;
using namespace config::rows;

const KeySpec kUrdf =
    text("urdf", "The URDF file that has the joints, relative to this one.").optional();
const KeySpec kFrames =
    section("frames", "Frames by name; goals are stated for 'tool'.").optional();
const KeySpec kPointingAxis =
    section("pointing_axis", "Of the tool, for goals that are a direction.").optional();
const KeySpec kShaft =
    section("shaft", "The straight shaft of an instrument whose tip is the tool's origin.")
        .optional();
const KeySpec kCapsules =
    section("capsules", "The bodies of the links by name, which keep away from forbidden zones.")
        .optional();
const KeySpec kMasses =
    section("masses", "The masses of the links by name, each in one point.").optional();
const KeySpec kHome =
    numbers("home_deg", "The position of all joints at the start.").also("home").optional();
const KeySpec kName = text("name", "The robot's name.");
const KeySpec kParent = text("parent", "A joint (with 'urdf' a link), 'base' or a frame.");
const KeySpec kJointName = text("name", "The joint's name.");

void append(std::vector<KeySpec>& keys, const std::vector<KeySpec>& more) {
  keys.insert(keys.end(), more.begin(), more.end());
}

/// What a joint may be besides its limits, in a row and in what is said of a URDF joint.
std::vector<KeySpec> drive_keys(Joint::Type type) {
  KeySpec inertia =
      number("drive_inertia_kg_m2", "Of its drive, as the joint feels it.").fallback("0").min(0);
  KeySpec within =
      number("coupled_within_deg", "A coupled joint's own sensor may say otherwise by this.")
          .above(0)
          .optional();
  if (type == Joint::Type::prismatic) {
    inertia.name = "drive_mass_kg";
    within.name = "coupled_within_m";
    within.also = "coupled_within_mm";
  }
  return {flag("locked", "Stands where it is at home while the arm works.").fallback("false"),
          inertia, within};
}

std::vector<KeySpec> limit_keys(Joint::Type type, bool optional) {
  const auto rate = [&](const char* name) {
    return number(name, "At most.").min(kMinRate).optional(optional);
  };
  KeySpec limits = numbers("limits_deg", "[lower, upper].").count(2).optional(optional);
  if (type == Joint::Type::revolute) {
    return {limits, rate("velocity_rad_s"), rate("acceleration_rad_s2")};
  }
  limits.name = "limits_m";
  limits.also = "limits_mm";
  return {limits, rate("velocity_m_s"), rate("acceleration_m_s2")};
}

}  // namespace

const std::vector<KeySpec>& robot_keys() {
  static const std::vector<KeySpec> kKeys{
      config::format_key("armature_robot"),
      kName,
      choice("convention", "Of the Denavit-Hartenberg rows; modified: Craig's.")
          .choices({"standard", "modified"})
          .fallback("standard"),
      kUrdf,
      section("joints", "All of them in order, coupled ones included."),
      kFrames,
      kPointingAxis,
      kShaft,
      kCapsules,
      kMasses,
      kHome};
  return kKeys;
}

const std::vector<KeySpec>& urdf_robot_keys() {
  static const std::vector<KeySpec> kKeys{
      config::format_key("armature_robot"),
      kName,
      kUrdf,
      text("base", "The link that the arm stands on; without: the root.").optional(),
      text("tip", "The link that goals are stated for."),
      section("joints", "What the URDF file does not say of a joint, or says otherwise.")
          .optional(),
      kFrames,
      kPointingAxis,
      kShaft,
      kCapsules,
      kMasses,
      kHome};
  return kKeys;
}

std::vector<KeySpec> joint_keys(Joint::Type type, bool is_coupled) {
  std::vector<KeySpec> keys{
      kJointName,
      choice("type", "Turns, turns without an end, or slides.")
          .choices({"revolute", "continuous", "prismatic"})
          .fallback("revolute"),
      number("theta_deg", "About z: the offset of a revolute joint, the angle of a prismatic one.")
          .fallback("0"),
      number("d_m", "Along z: the offset of a prismatic joint, the place of a revolute one.")
          .fallback("0")
          .also("d_mm"),
      number("a_m", "Along x.").fallback("0").also("a_mm"),
      number("alpha_deg", "About x.").fallback("0"),
      section("coupled", "This joint follows another one.").optional()};
  append(keys, limit_keys(type, is_coupled));
  append(keys, drive_keys(type));
  return keys;
}

std::vector<KeySpec> urdf_joint_keys(Joint::Type type) {
  std::vector<KeySpec> keys{kJointName};
  append(keys, limit_keys(type, true));
  append(keys, drive_keys(type));
  return keys;
}

std::vector<KeySpec> coupling_keys(Joint::Type type) {
  KeySpec offset = number("offset_deg", "Is added.").fallback("0");
  if (type == Joint::Type::prismatic) {
    offset.name = "offset_m";
    offset.also = "offset_mm";
  }
  return {text("to", "The joint that it follows."),
          number("ratio", "How far it moves when the other one moves by 1.")
              .fallback("1")
              .range(-kMaxRatio, kMaxRatio)
              .because("no gear is as steep; is it told in another unit?"),
          offset};
}

const std::vector<KeySpec>& frame_keys() {
  static const std::vector<KeySpec> kKeys{
      text("parent", "A joint (with 'urdf' a link), 'base' or another frame."),
      numbers("translation_m", "Of its origin in the parent, x, y, z.")
          .count(3)
          .also("translation_mm")
          .optional(),
      numbers("rpy_deg", "Its rotation, about the parent's x, then y, then z.").count(3).optional(),
      text("calibrated",
           "A file of `armature calibrate` that found where it is, relative to this one.")
          .optional()};
  return kKeys;
}

const std::vector<KeySpec>& capsule_keys() {
  const auto end = [](const char* name, const char* also, const char* doc) {
    return numbers(name, doc).count(3).also(also);
  };
  static const std::vector<KeySpec> kKeys{
      kParent, end("from_m", "from_mm", "Where its middle line begins in the parent, x, y, z."),
      end("to_m", "to_mm", "Where it ends; the same point for a ball."),
      number("radius_m", "About that line.").above(0).also("radius_mm")};
  return kKeys;
}

const std::vector<KeySpec>& mass_keys() {
  static const std::vector<KeySpec> kKeys{
      kParent,
      numbers("centre_m", "Where it is in the parent, x, y, z.").count(3).also("centre_mm"),
      number("mass_kg", "How much.").above(0)};
  return kKeys;
}

const std::vector<KeySpec>& shaft_keys() {
  static const std::vector<KeySpec> kKeys{
      section("axis", "Of the tool, from the hand to the tip."),
      number("length_m", "From the tip, as far as it is straight.").above(0).also("length_mm")};
  return kKeys;
}

const std::vector<std::string>& axis_words() {
  static const std::vector<std::string> kWords{"x", "y", "z", "-x", "-y", "-z"};
  return kWords;
}

}  // namespace armature
