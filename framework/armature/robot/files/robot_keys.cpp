// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/robot_keys.hpp"

#include <utility>

namespace armature {
namespace {

using config::default_value;
using config::KeySpec;
using Type = KeySpec::Type;

/// A section that may be missing.
KeySpec section(std::string name, std::string doc) {
  return {.name = std::move(name), .type = Type::section, .doc = std::move(doc), .optional = true};
}

const KeySpec kUrdf{.name = "urdf",
                    .type = Type::text,
                    .doc = "The URDF file that has the joints, relative to this one.",
                    .optional = true};
const KeySpec kFrames = section("frames", "Frames by name; goals are stated for 'tool'.");
const KeySpec kPointingAxis =
    section("pointing_axis", "Of the tool, for goals that are a direction.");
const KeySpec kShaft =
    section("shaft", "The straight shaft of an instrument whose tip is the tool's origin.");
const KeySpec kCapsules =
    section("capsules", "The bodies of the links by name, which keep away from forbidden zones.");
const KeySpec kMasses = section("masses", "The masses of the links by name, each in one point.");
const KeySpec kHome{.name = "home_deg",
                    .type = Type::numbers,
                    .doc = "The position of all joints at the start.",
                    .optional = true,
                    .also = "home"};
const KeySpec kName{.name = "name", .type = Type::text, .doc = "The robot's name."};
const KeySpec kParent{.name = "parent",
                      .type = Type::text,
                      .doc = "A joint (with 'urdf' a link), 'base' or a frame."};
const KeySpec kJointName{.name = "name", .type = Type::text, .doc = "The joint's name."};

void append(std::vector<KeySpec>& keys, const std::vector<KeySpec>& more) {
  keys.insert(keys.end(), more.begin(), more.end());
}

/// What a joint may be besides its limits, in a row and in what is said of a URDF joint.
std::vector<KeySpec> drive_keys(Joint::Type type) {
  KeySpec inertia{.name = "drive_inertia_kg_m2",
                  .doc = "Of its drive, as the joint feels it.",
                  .fallback = default_value("0"),
                  .min = 0};
  KeySpec within{.name = "coupled_within_deg",
                 .doc = "A coupled joint's own sensor may say otherwise by this.",
                 .optional = true,
                 .above = 0};
  if (type == Joint::Type::prismatic) {
    inertia.name = "drive_mass_kg";
    within.name = "coupled_within_m";
    within.also = "coupled_within_mm";
  }
  return {{.name = "locked",
           .type = Type::flag,
           .doc = "Stands where it is at home while the arm works.",
           .fallback = default_value("false")},
          inertia,
          within};
}

std::vector<KeySpec> limit_keys(Joint::Type type, bool optional) {
  const auto rate = [&](std::string name) {
    return KeySpec{
        .name = std::move(name), .doc = "At most.", .min = kMinRate, .optional = optional};
  };
  KeySpec limits{.name = "limits_deg",
                 .type = Type::numbers,
                 .doc = "[lower, upper].",
                 .count = 2,
                 .optional = optional};
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
      {.name = "convention",
       .type = Type::choice,
       .doc = "Of the Denavit-Hartenberg rows; modified: Craig's.",
       .fallback = default_value("standard"),
       .choices = {"standard", "modified"}},
      kUrdf,
      {.name = "joints",
       .type = Type::section,
       .doc = "All of them in order, coupled ones included."},
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
      {.name = "base",
       .type = Type::text,
       .doc = "The link that the arm stands on; without: the root.",
       .optional = true},
      {.name = "tip", .type = Type::text, .doc = "The link that goals are stated for."},
      section("joints", "What the URDF file does not say of a joint, or says otherwise."),
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
      {.name = "type",
       .type = Type::choice,
       .doc = "Turns, turns without an end, or slides.",
       .fallback = default_value("revolute"),
       .choices = {"revolute", "continuous", "prismatic"}},
      {.name = "theta_deg",
       .doc = "About z: the offset of a revolute joint, the angle of a prismatic one.",
       .fallback = default_value("0")},
      {.name = "d_m",
       .doc = "Along z: the offset of a prismatic joint, the place of a revolute one.",
       .fallback = default_value("0"),
       .also = "d_mm"},
      {.name = "a_m", .doc = "Along x.", .fallback = default_value("0"), .also = "a_mm"},
      {.name = "alpha_deg", .doc = "About x.", .fallback = default_value("0")},
      section("coupled", "This joint follows another one.")};
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
  KeySpec offset{.name = "offset_deg", .doc = "Is added.", .fallback = default_value("0")};
  if (type == Joint::Type::prismatic) {
    offset.name = "offset_m";
    offset.also = "offset_mm";
  }
  return {{.name = "to", .type = Type::text, .doc = "The joint that it follows."},
          {.name = "ratio",
           .doc = "How far it moves when the other one moves by 1.",
           .fallback = default_value("1"),
           .min = -kMaxRatio,
           .max = kMaxRatio,
           .because = "no gear is as steep; is it told in another unit?"},
          offset};
}

const std::vector<KeySpec>& frame_keys() {
  static const std::vector<KeySpec> kKeys{
      {.name = "parent",
       .type = Type::text,
       .doc = "A joint (with 'urdf' a link), 'base' or another frame."},
      {.name = "translation_m",
       .type = Type::numbers,
       .doc = "Of its origin in the parent, x, y, z.",
       .count = 3,
       .optional = true,
       .also = "translation_mm"},
      {.name = "rpy_deg",
       .type = Type::numbers,
       .doc = "Its rotation, about the parent's x, then y, then z.",
       .count = 3,
       .optional = true},
      {.name = "calibrated",
       .type = Type::text,
       .doc = "A file of `armature calibrate` that found where it is, relative to this one.",
       .optional = true}};
  return kKeys;
}

const std::vector<KeySpec>& capsule_keys() {
  const auto end = [](const char* name, const char* also, const char* doc) {
    return KeySpec{.name = name, .type = Type::numbers, .doc = doc, .count = 3, .also = also};
  };
  static const std::vector<KeySpec> kKeys{
      kParent,
      end("from_m", "from_mm", "Where its middle line begins in the parent, x, y, z."),
      end("to_m", "to_mm", "Where it ends; the same point for a ball."),
      {.name = "radius_m", .doc = "About that line.", .above = 0, .also = "radius_mm"}};
  return kKeys;
}

const std::vector<KeySpec>& mass_keys() {
  static const std::vector<KeySpec> kKeys{kParent,
                                          {.name = "centre_m",
                                           .type = Type::numbers,
                                           .doc = "Where it is in the parent, x, y, z.",
                                           .count = 3,
                                           .also = "centre_mm"},
                                          {.name = "mass_kg", .doc = "How much.", .above = 0}};
  return kKeys;
}

const std::vector<KeySpec>& shaft_keys() {
  static const std::vector<KeySpec> kKeys{
      {.name = "axis", .type = Type::section, .doc = "Of the tool, from the hand to the tip."},
      {.name = "length_m",
       .doc = "From the tip, as far as it is straight.",
       .above = 0,
       .also = "length_mm"}};
  return kKeys;
}

const std::vector<std::string>& axis_words() {
  static const std::vector<std::string> kWords{"x", "y", "z", "-x", "-y", "-z"};
  return kWords;
}

}  // namespace armature
