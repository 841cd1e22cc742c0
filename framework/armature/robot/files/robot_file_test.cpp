// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "armature/config/document.hpp"
#include "armature/config/unit_suffix.hpp"
#include "armature/robot/files/robot_keys.hpp"
#include "armature/robot/files/stereo_rig.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/model/test_robots.hpp"
#include "tests/refusal.hpp"

namespace armature {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::joint_vector;

RobotModel read_good(const std::string& text) {
  return read_robot_model(config::parse_text(text, "arm.yaml"));
}

std::vector<std::string> problems_in(const std::string& text) {
  return test::problems_of([&] { read_robot_model(config::parse_text(text, "arm.yaml")); });
}

/// Two joints, the second one as given, and what follows the joints.
std::string with(const std::string& second, const std::string& rest) {
  return "armature_robot: 1\n"
         "name: two\n"
         "joints:\n"
         "  - {name: a, limits_deg: [-90, 90], velocity_rad_s: 1, acceleration_rad_s2: 2}\n"
         "  - " +
         second + "\n" + rest + "\n";
}
const std::string kGoodJoint =
    "{name: b, limits_deg: [-90, 90], velocity_rad_s: 1, acceleration_rad_s2: 2}";
const std::string kGoodFrames = "frames: {tool: {parent: b}}";

TEST(RobotFile, NamesTheShaftOfAnInstrument) {
  const std::string good = with(kGoodJoint, kGoodFrames);
  EXPECT_FALSE(read_good(good).shaft());
  const RobotModel robot = read_good(good + "shaft: {axis: [0, 0, -2], length_mm: 280}\n");
  ASSERT_TRUE(robot.shaft());
  EXPECT_TRUE(robot.shaft()->axis == -Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(robot.shaft()->length, 0.28, 1e-15);
}

TEST(RobotFile, StatesTheBodiesOfItsLinks) {
  const std::string good =
      with(kGoodJoint, "frames: {tool: {parent: b, translation_m: [1, 0, 0]}}");
  EXPECT_TRUE(read_good(good).capsules().empty());
  const RobotModel robot =
      read_good(good +
                "capsules:\n"
                "  arm: {parent: a, from_m: [0, 0, 0], to_m: [0.4, 0, 0], radius_mm: 80}\n"
                "  tip: {parent: tool, from_mm: [0, 0, 10], to_mm: [0, 0, 10], radius_m: 0.02}\n");
  ASSERT_EQ(robot.capsules().size(), 2u);
  EXPECT_EQ(robot.capsules()[0].name, "arm");
  EXPECT_EQ(robot.capsules()[0].parent_joint, 0);
  EXPECT_EQ(robot.capsules()[0].to, Eigen::Vector3d(0.4, 0, 0));
  EXPECT_NEAR(robot.capsules()[0].radius, 0.08, 1e-15);
  EXPECT_EQ(robot.capsules()[1].parent_joint, 1);
  EXPECT_LT((robot.capsules()[1].from - Eigen::Vector3d{1, 0, 0.01}).norm(), 1e-15);
}

TEST(RobotFile, ABodyHangsOnALinkAndHasARadius) {
  const std::string good = with(kGoodJoint, kGoodFrames);
  EXPECT_THAT(problems_in(good + "capsules: {arm: {parent: bb, from_m: [0, 0, 0], radius_m: 0}}\n"),
              ElementsAre("arm.yaml:7:17: missing key 'to_m' in capsule 'arm'",
                          "arm.yaml:7:26: there is no joint or frame 'bb'; did you mean 'b'?",
                          "arm.yaml:7:59: 'radius_m' is 0, must be more than 0"));
  EXPECT_THAT(problems_in(good + "capsules: [arm]\n"),
              ElementsAre(HasSubstr("'capsules' must be a map of capsules, not")));
}

TEST(RobotFile, StatesMassesAndDrives) {
  const RobotModel robot =
      read_good(with("{name: b, limits_deg: [-90, 90], velocity_rad_s: 1, acceleration_rad_s2: 1, "
                     "drive_inertia_kg_m2: 0.8}",
                     kGoodFrames) +
                "masses: {arm: {parent: b, centre_mm: [100, 0, 0], mass_kg: 4.8}}\n");
  EXPECT_EQ(robot.joints()[1].drive_inertia, 0.8);
  ASSERT_EQ(robot.masses().size(), 1u);
  EXPECT_EQ(robot.masses()[0].parent_joint, 1);
  EXPECT_LT((robot.masses()[0].centre - Eigen::Vector3d{0.1, 0, 0}).norm(), 1e-15);
  EXPECT_EQ(robot.masses()[0].mass, 4.8);
  EXPECT_THAT(
      problems_in(with(kGoodJoint, kGoodFrames) + "masses: {arm: {parent: b, mass_kg: -1}}\n"),
      ElementsAre("arm.yaml:7:15: missing key 'centre_m' in mass 'arm'",
                  "arm.yaml:7:36: 'mass_kg' is -1, must be more than 0"));
}

const std::string kLockedJoint =
    "{name: b, locked: true, limits_deg: [-90, 90], velocity_rad_s: 1, acceleration_rad_s2: 1}";

TEST(RobotFile, LocksAJointWhereItIsAtHome) {
  const RobotModel robot = read_good(with(kLockedJoint, kGoodFrames + "\nhome_deg: [0, 30]"));
  EXPECT_EQ(robot.joint_count(), 2);
  EXPECT_EQ(robot.dof(), 1);
  EXPECT_NEAR(robot.to_all(JointVector::Zero(1))[1], std::numbers::pi / 6, 1e-15);
}

TEST(RobotFile, RefusesALockWithoutAHomeOutOfLimitsOrOnACoupledJoint) {
  EXPECT_THAT(problems_in(with(kLockedJoint, kGoodFrames)),
              ElementsAre(HasSubstr("joint 'b' is locked where it is at home, and the file has "
                                    "none; add home_deg: or home:")));
  EXPECT_THAT(problems_in(with(kLockedJoint, kGoodFrames + "\nhome_deg: [0, 91]")),
              ElementsAre("arm.yaml:7:11: 'home_deg': b = 91 deg is outside of -90 deg to 90 deg"));
  EXPECT_THAT(problems_in(with("{name: b, locked: true, coupled: {to: a}}",
                               kGoodFrames + "\nhome: [0, 0]")),
              ElementsAre(HasSubstr("a joint is coupled or locked, not both")));
  const std::string locked_leader =
      "armature_robot: 1\nname: three\nhome: [0, 0, 0]\njoints:\n  - " + kLockedJoint +
      "\n  - {name: c, coupled: {to: b}}\n"
      "  - {name: d, limits_deg: [-90, 90], velocity_rad_s: 1, acceleration_rad_s2: 1}\n"
      "frames: {tool: {parent: d}}\n";
  EXPECT_THAT(problems_in(locked_leader),
              ElementsAre(HasSubstr("joint 'c' follows 'b', which is locked")));
}

TEST(RobotFile, TakesAHomeAtALimitThatACoupledJointSets) {
  const RobotModel robot =
      read_good(with("{name: b, coupled: {to: a, offset_deg: 15}, limits_deg: [-70, 90]}",
                     kGoodFrames + "\nhome_deg: [-85, -70]"));
  EXPECT_NEAR(robot.lower()[0], (*robot.home())[0], 1e-15);
}

TEST(RobotFile, StatesHowFarACoupledJointMayBeMeasuredFromItsLeader) {
  const RobotModel robot =
      read_good(with("{name: b, coupled: {to: a}, coupled_within_deg: 0.2}", kGoodFrames));
  EXPECT_NEAR(*robot.joints()[1].coupling->within, 0.2 * std::numbers::pi / 180, 1e-15);
  EXPECT_THAT(problems_in(with("{name: b, coupled: {to: a}, coupled_within_deg: 0}", kGoodFrames)),
              ElementsAre(HasSubstr("'coupled_within_deg' is 0, must be more than 0")));
  EXPECT_THAT(
      problems_in(with("{name: b, limits_deg: [-90, 90], velocity_rad_s: 1, "
                       "acceleration_rad_s2: 1, coupled_within_deg: 0.2}",
                       kGoodFrames)),
      ElementsAre(HasSubstr("'coupled_within_deg' is for a coupled joint, which 'b' is not")));
}

TEST(RobotFile, RefusesARatioThatNoGearHas) {
  const auto said = [](const std::string& ratio) {
    return problems_in(with("{name: b, coupled: {to: a, ratio: " + ratio + "}}", kGoodFrames));
  };
  for (const char* huge : {"1e308", "-1e308"}) {
    EXPECT_THAT(said(huge), ElementsAre(HasSubstr("must be from -1000000 to 1000000: no gear is as "
                                                  "steep; is it told in another unit?")))
        << huge;
  }
  for (const char* tiny : {"0", "1e-300", "-1e-300"}) {
    EXPECT_THAT(said(tiny), ElementsAre(HasSubstr("must not be nearer to 0 than 1e-06; a joint "
                                                  "that does not move is a fixed angle")))
        << tiny;
  }
  EXPECT_THAT(said("-62832"), ElementsAre()) << "a screw of 0.1 mm a turn";
}

TEST(RobotFile, RefusesALimitWithWhichNothingMoves) {
  for (const char* rates : {"velocity_rad_s: 1e-300, acceleration_rad_s2: 2",
                            "velocity_rad_s: 1, acceleration_rad_s2: 1e-300"}) {
    EXPECT_THAT(problems_in(with(std::string{"{name: b, limits_deg: [-90, 90], "} + rates + "}",
                                 kGoodFrames)),
                ElementsAre(HasSubstr("is 1e-300, must be at least 1e-06")))
        << rates;
  }
}

TEST(RobotFile, AShaftIsALineWithALength) {
  const std::string good = with(kGoodJoint, kGoodFrames);
  EXPECT_THAT(problems_in(good + "shaft: {axis: w, length_m: 0}\n"),
              ElementsAre("arm.yaml:7:15: 'axis' must be x, y, z, -x, -y, -z or a list of 3 "
                          "numbers, not 'w'",
                          "arm.yaml:7:28: 'length_m' is 0, must be more than 0"));
  EXPECT_THAT(problems_in(good + "shaft: {axis: z}\n"),
              ElementsAre("arm.yaml:7:8: missing key 'length_m' in shaft"));
}

TEST(RobotFile, OfTheLampIsThePapersTableWithTheParallelogram) {
  const RobotModel lamp = testing::dental_lamp();
  const double deg = std::numbers::pi / 180;
  EXPECT_EQ(lamp.name(), "dental_lamp");
  EXPECT_EQ(lamp.joint_count(), 6);
  EXPECT_EQ(lamp.dof(), 5);
  EXPECT_EQ(lamp.joints()[0].d, 0.45257);
  EXPECT_EQ(lamp.joints()[1].d, 0.2515);
  EXPECT_EQ(lamp.joints()[4].d, -0.2);
  EXPECT_NEAR(lamp.joints()[3].alpha, -90 * deg, 1e-15);
  EXPECT_EQ(lamp.joints()[3].coupling->to, 2);
  EXPECT_EQ(lamp.joints()[3].coupling->ratio, -1);
  EXPECT_TRUE(lamp.upper().isApprox(joint_vector({170, 160, 60, 170, 80}) * deg));
  EXPECT_TRUE(lamp.lower() == -lamp.upper());
  EXPECT_TRUE(lamp.max_velocity() == JointVector::Constant(5, 2.5));
  EXPECT_TRUE(lamp.max_acceleration() == JointVector::Constant(5, 8));
  EXPECT_TRUE(*lamp.pointing_axis() == Eigen::Vector3d::UnitX());
  EXPECT_TRUE(lamp.home()->isApprox(joint_vector({60, -120, 0, 0, 150, 0}) * deg));
  EXPECT_EQ(lamp.frame(lamp.tool()).parent_joint, 5);
}

TEST(RobotFile, MayStateMillimetresPrismaticJointsAndOffsets) {
  const RobotModel robot = read_good(
      "armature_robot: 1\n"
      "name: press\n"
      "convention: modified\n"
      "joints:\n"
      "  - {name: turn, theta_deg: 90, d_mm: 120, a_mm: 30, limits_deg: [-90, 90],\n"
      "     velocity_rad_s: 1, acceleration_rad_s2: 2}\n"
      "  - {name: slide, type: prismatic, alpha_deg: -90, limits_mm: [0, 250],\n"
      "     velocity_m_s: 0.1, acceleration_m_s2: 0.5}\n"
      "  - {name: twin, type: prismatic, coupled: {to: slide, ratio: 2, offset_mm: 5}}\n"
      "frames: {tool: {parent: twin}}\n"
      "pointing_axis: [0, 0, -2]\n"
      "home: [0.5, 0.1, 0.205]\n");
  EXPECT_EQ(robot.convention(), RobotModel::Convention::modified);
  EXPECT_NEAR(robot.joints()[0].theta, std::numbers::pi / 2, 1e-15);
  EXPECT_EQ(robot.joints()[0].d, 0.12);
  EXPECT_EQ(robot.joints()[0].a, 0.03);
  EXPECT_FALSE(robot.is_revolute(1));
  EXPECT_EQ(robot.upper()[1], 0.25);
  EXPECT_EQ(robot.joints()[2].coupling->offset, 0.005);
  EXPECT_TRUE(*robot.pointing_axis() == -Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(*robot.home() == joint_vector({0.5, 0.1, 0.205}));
}

TEST(RobotFile, HasJointsThatTurnWithoutAnEnd) {
  const RobotModel robot = read_good(
      "armature_robot: 1\n"
      "name: spindle\n"
      "joints: [{name: turn, type: continuous, velocity_rad_s: 8, acceleration_rad_s2: 200}]\n"
      "frames: {tool: {parent: turn}}\n");
  EXPECT_TRUE(robot.is_revolute(0));
  EXPECT_TRUE(robot.within_limits(joint_vector({1e6})));
  EXPECT_EQ(robot.max_velocity()[0], 8);
}

TEST(RobotFile, HangsFramesOnJointsTheBaseAndOtherFrames) {
  const RobotModel robot =
      read_good(with(kGoodJoint,
                     "frames:\n"
                     "  lens: {parent: tool, translation_mm: [0, 0, 10]}\n"
                     "  tool: {parent: b, translation_m: [1, 2, 3], rpy_deg: [90, 0, 90]}\n"
                     "  floor: {parent: base, translation_m: [0, 0, -1]}"));
  const auto frame = [&](const char* name) { return robot.frame(*robot.find_frame(name)); };
  EXPECT_EQ(robot.tool(), *robot.find_frame("tool"));
  EXPECT_EQ(frame("lens").parent_joint, 1);
  EXPECT_EQ(frame("floor").parent_joint, -1);
  // About x by 90: z -> -y; then about z by 90: -y -> x.
  EXPECT_TRUE((frame("tool").parent_T_frame.linear() * Eigen::Vector3d::UnitZ())
                  .isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_TRUE(frame("lens").parent_T_frame.translation().isApprox(Eigen::Vector3d{1.01, 2, 3}));
}

TEST(RobotFile, ReportsEverythingThatIsWrongAtOnceWithItsPlace) {
  EXPECT_THAT(
      problems_in("armature_robot: 2\n"
                  "name: broken\n"
                  "convention: standart\n"
                  "joints:\n"
                  "  - {name: a, limits_deg: [90, -90], velocity_rad_s: 0, "
                  "acceleration_rad_s2: 2}\n"
                  "  - {name: b, type: prismatic, limits_deg: [0, 1], velocity_m_s: 1, "
                  "acceleration_m_s2: 2}\n"
                  "  - {name: c, coupled: {to: d, ratio: 0}}\n"
                  "  - {name: e, coupled: {to: c}}\n"
                  "  - {name: a, d_m: 1, d_mm: 1000, coupled: {to: b}}\n"
                  "frames: {hand: {parent: f}}\n"
                  "pointing_axis: w\n"
                  "home_deg: [1, 2]\n"
                  "colour: red\n"),
      ElementsAre(
          "arm.yaml:1:17: 'armature_robot' is 2, must be 1: the format that this version reads",
          "arm.yaml:3:13: 'convention' cannot be 'standart'; did you mean 'standard'?",
          "arm.yaml:5:27: 'limits_deg' is [lower, upper], and 90 is not below -90",
          "arm.yaml:5:54: 'velocity_rad_s' is 0, must be at least 1e-06",
          "arm.yaml:6:5: missing key 'limits_m' in joint 'b'",
          "arm.yaml:6:32: unknown key 'limits_deg' in joint 'b'; did you mean 'limits_m' or "
          "'limits_mm'?",
          "arm.yaml:7:29: there is no joint 'd'; known: a, b, c, e, a",
          "arm.yaml:7:39: 'ratio' is 0, and must not be nearer to 0 than 1e-06; a joint that does "
          "not move is a fixed angle",
          "arm.yaml:8:29: joint 'e' cannot follow 'c', which is coupled itself; name a joint that "
          "moves by itself",
          "arm.yaml:9:12: there is a joint 'a' already",
          "arm.yaml:9:29: 'd_m' and 'd_mm' state the same; keep one",
          "arm.yaml:10:9: there is no frame 'tool', for which goals are stated; add frames: {tool: "
          "{parent: a}}",
          "arm.yaml:10:25: there is no joint or frame 'f'; known: base, a, b, c, e, a, hand",
          "arm.yaml:11:16: 'pointing_axis' must be x, y, z, -x, -y, -z or a list of 3 numbers, not "
          "'w'",
          "arm.yaml:12:11: 'home_deg' cannot state the prismatic joint 'b'; write 'home' in "
          "radians and metres",
          "arm.yaml:12:11: 'home_deg' needs a value for each of the 5 joints, not 2",
          "arm.yaml:13:1: unknown key 'colour' in robot; known: armature_robot, capsules, "
          "convention, "
          "frames, "
          "home, home_deg, joints, masses, ..."));
}

TEST(RobotFile, WithoutAToolFrameSaysHowToAddIt) {
  EXPECT_THAT(problems_in(with(kGoodJoint, "")),
              ElementsAre("arm.yaml:1:1: there is no frame 'tool', for which goals are stated; add "
                          "frames: {tool: {parent: b}}"));
}

TEST(RobotFile, AsksForTheLimitsOfIndependentJointsOnly) {
  EXPECT_THAT(problems_in(with("{name: b}", kGoodFrames)),
              ElementsAre("arm.yaml:5:5: missing key 'limits_deg' in joint 'b'",
                          "arm.yaml:5:5: missing key 'velocity_rad_s' in joint 'b'",
                          "arm.yaml:5:5: missing key 'acceleration_rad_s2' in joint 'b'"));
  EXPECT_EQ(read_good(with("{name: b, coupled: {to: a}}", kGoodFrames)).dof(), 1);
}

TEST(RobotFile, RefusesAHomeThatTheRobotCannotTake) {
  EXPECT_THAT(problems_in(with(kGoodJoint, kGoodFrames + "\nhome_deg: [0, 91]")),
              ElementsAre("arm.yaml:7:11: 'home_deg': b = 91 deg is outside of -90 deg to 90 deg"));
  EXPECT_THAT(problems_in(with(kGoodJoint, kGoodFrames + "\nhome_deg: [0, 90.00001]")),
              ElementsAre(HasSubstr("b = 90.00001 deg is outside of -90 deg to 90 deg")));
  EXPECT_THAT(
      problems_in(with("{name: b, coupled: {to: a}}", kGoodFrames + "\nhome: [0, 0.5]")),
      ElementsAre("arm.yaml:7:7: 'home': b = 0.5 contradicts its coupling to a, which makes it 0"));
}

TEST(RobotFile, RefusesLimitsThatExcludeEachOther) {
  EXPECT_THAT(
      problems_in(with("{name: b, limits_deg: [100, 120], coupled: {to: a}}", kGoodFrames)),
      ElementsAre("arm.yaml:4:3: joint 'a' has no room to move: its limits and those of the "
                  "joints that follow it exclude each other"));
}

TEST(RobotFile, RefusesFramesInACircleAndNamesThatAreTaken) {
  EXPECT_THAT(problems_in(with(kGoodJoint,
                               "frames:\n"
                               "  tool: {parent: grip}\n"
                               "  grip: {parent: tool}\n"
                               "  b: {parent: base}")),
              ElementsAre("arm.yaml:7:18: frames in a circle: tool -> grip -> tool",
                          "arm.yaml:8:18: frames in a circle: grip -> tool -> grip",
                          "arm.yaml:9:3: 'b' is the name of a joint or of the base; a frame needs "
                          "its own"));
}

TEST(RobotFile, RefusesWrongShapes) {
  EXPECT_THAT(problems_in("3"), ElementsAre("arm.yaml:1:1: robot must be a map, not '3'"));
  EXPECT_THAT(problems_in("{armature_robot: 1, name: r, joints: [], frames: {}}"),
              ElementsAre("arm.yaml:1:38: 'joints' must be a list of joints, not empty"));
  EXPECT_THAT(problems_in("{armature_robot: 1, name: r, joints: 3, frames: 4}"),
              ElementsAre("arm.yaml:1:38: 'joints' must be a list of joints, not '3'",
                          "arm.yaml:1:49: 'frames' must be a map of frames, not '4'"));
  EXPECT_THAT(problems_in(with(kGoodJoint,
                               "frames: {tool: {parent: b, rpy_deg: [1, 2]}}\n"
                               "pointing_axis: [0, 0, 0]")),
              ElementsAre("arm.yaml:6:37: 'rpy_deg' must be a list of 3 numbers, not of 2",
                          "arm.yaml:7:16: 'pointing_axis' has no length"));
}

TEST(RobotFile, RefusesMoreJointsThanFit) {
  std::string text = "armature_robot: 1\nname: snake\njoints:\n";
  for (int i = 0; i < 13; ++i)
    text += "  - {name: j" + std::to_string(i) +
            ", limits_deg: [0, 1], velocity_rad_s: 1, acceleration_rad_s2: 1}\n";
  EXPECT_THAT(problems_in(text + "frames: {tool: {parent: j12}}"),
              ElementsAre("arm.yaml:4:3: 13 joints are too many; a robot may have 12"));
}

TEST(RobotFile, HasTablesOfKeysWithUnitsThatAreReadAndADoc) {
  using Type = Joint::Type;
  for (const auto& table : {robot_keys(), urdf_robot_keys(), joint_keys(Type::revolute, false),
                            joint_keys(Type::prismatic, true), urdf_joint_keys(Type::prismatic),
                            coupling_keys(Type::revolute), coupling_keys(Type::prismatic),
                            frame_keys(), rig_keys(), mount_keys()}) {
    for (const config::KeySpec& key : table) {
      EXPECT_EQ(config::unknown_unit(key.name), "");
      EXPECT_EQ(config::unknown_unit(key.also), "") << key.name;
      EXPECT_NE(key.doc, "") << key.name;
    }
  }
}

}  // namespace
}  // namespace armature
