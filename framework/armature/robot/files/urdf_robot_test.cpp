// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/urdf_robot.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "armature/config/document.hpp"
#include "armature/robot/files/urdf_file_test.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/model/test_robots.hpp"
#include "armature/values/file_content.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::UrdfFile;

const fs::path kData = ARMATURE_SOURCE_DIR "/tests/data/urdf";

RobotModel load(const std::string& name, const std::string& base, const std::string& tip) {
  return load_urdf_robot(kData / (name + ".urdf"), {base, {"--base", 0, 0}},
                         {tip, {"--tip", 0, 0}});
}

const std::string kLimit = "<limit lower='-1' upper='1' effort='1' velocity='2'/>";

TEST(UrdfRobot, HasJointsLimitsAndAFrameForEveryLinkOnTheWay) {
  const RobotModel arm = load("gantry", "", "gripper");
  EXPECT_EQ(arm.name(), "gantry");
  ASSERT_EQ(arm.joint_count(), 5);
  EXPECT_EQ(arm.joints()[2].name, "down");
  EXPECT_FALSE(arm.is_revolute(2));
  EXPECT_EQ(arm.upper()[2], 0.8);
  EXPECT_EQ(arm.max_velocity()[2], 0.5);
  EXPECT_EQ(arm.max_acceleration()[2], 2);  // the top speed in 0.25 s
  EXPECT_TRUE(std::isinf(arm.upper()[3]));  // continuous
  EXPECT_EQ(arm.frame(arm.tool()).name, "gripper");
  std::vector<std::string> names;
  for (const NamedFrame& frame : arm.frames()) names.push_back(frame.name);
  EXPECT_THAT(
      names, ElementsAre("rail", "bridge", "beam", "trolley", "column", "fork", "head", "gripper"));
  EXPECT_EQ(arm.frame(*arm.find_frame("rail")).parent_joint, -1);
  EXPECT_EQ(arm.frame(*arm.find_frame("beam")).parent_joint, 0);
}

TEST(UrdfRobot, AMimickingJointIsCoupled) {
  const RobotModel arm = load("seven_joints", "base_link", "hand");
  EXPECT_EQ(arm.dof(), 6);
  ASSERT_TRUE(arm.joints()[3].coupling);
  EXPECT_EQ(arm.joints()[3].coupling->to, 2);
  EXPECT_EQ(arm.joints()[3].coupling->ratio, -0.5);
  EXPECT_EQ(arm.joints()[3].coupling->offset, 0.1);
}

TEST(UrdfRobot, RestsWithinLimitsAndUnlimitedJointsAtZero) {
  const RobotModel arm = load("seven_joints", "base_link", "hand");
  const JointVector q = resting_position(arm);
  EXPECT_EQ(q[0], 0);
  EXPECT_EQ(q[1], 0.25);
  EXPECT_TRUE(arm.within_limits(q));
}

TEST(UrdfRobot, OnlyWhatRoundedAnglesPullApartIsPlaced) {
  const RobotModel puma = load("skew_puma", "world", "tool0");
  EXPECT_TRUE(puma.joints()[0].placement);  // stands askew
  for (std::size_t i = 1; i < 6; ++i) EXPECT_FALSE(puma.joints()[i].placement) << i;
  const RobotModel seven = load("seven_joints", "", "hand");
  std::vector<bool> placed;
  for (const Joint& joint : seven.joints()) placed.push_back(joint.placement.has_value());
  EXPECT_THAT(placed, ElementsAre(false, false, true, false, false, false, false));
}

TEST_F(UrdfFile, NamesTheNearestLinks) {
  const std::string good = arm("revolute", kLimit);
  EXPECT_THAT(problems_of(good, "", "hnad"),
              ElementsAre("--tip: there is no link 'hnad' in arm.urdf; did you mean 'hand'?"));
  EXPECT_THAT(
      problems_of(good, "base_lnk"),
      ElementsAre("--base: there is no link 'base_lnk' in arm.urdf; did you mean 'base_link'?"));
  EXPECT_THAT(problems_of(good, "", ""),
              ElementsAre("--tip: the link that goals are stated for is missing; links at the ends "
                          "of arm.urdf: hand"));
  EXPECT_THAT(
      problems_of(good, "hand", "l1"),
      ElementsAre("--base: link 'hand' does not carry 'l1', which hangs on l1 < base_link"));
  EXPECT_THAT(problems_of(good, "hand", "hand"),
              ElementsAre("--tip: no joint of arm.urdf moves between 'hand' and 'hand'"));
}

TEST_F(UrdfFile, OfAFloatingOrPlanarJointIsRefused) {
  EXPECT_THAT(problems_of(arm("floating", "")),
              ElementsAre("arm.urdf:3:1: joint 'j2' is floating, which is no joint of an arm; name "
                          "a base behind it"));
  EXPECT_THAT(problems_of(arm("planar", "")),
              ElementsAre("arm.urdf:3:1: joint 'j2' is planar, which is no joint of an arm; name a "
                          "base behind it"));
}

TEST_F(UrdfFile, MayNotCallAMovingJointAsTheRobotsFoot) {
  std::string text = arm("continuous", "");
  text.replace(text.find("'j2'"), 4, "'base'");
  EXPECT_THAT(
      problems_of(text),
      ElementsAre("arm.urdf:3:1: a joint cannot be called 'base', which is the robot's foot"));
  text.replace(text.find("continuous"), 10, "fixed");
  EXPECT_THAT(problems_of(text), ElementsAre());
}

TEST_F(UrdfFile, SaysWhichJointHasNoUsableLimits) {
  EXPECT_THAT(problems_of(arm("revolute", "")),
              ElementsAre(HasSubstr("arm.urdf:3:1: not a robot description that urdfdom reads: ")));
  EXPECT_THAT(problems_of(arm("prismatic", "<limit effort='1' velocity='2'/>")),
              ElementsAre("arm.urdf:3:1: joint 'j2' has no room to move: its limits are 0 to 0; "
                          "correct it there, or in a robot file: joints: [{name: j2, limits_m: [0, "
                          "1]}]"));
  EXPECT_THAT(
      problems_of(arm("revolute", "<limit lower='-1' upper='1' effort='1' velocity='-2'/>")),
      ElementsAre("arm.urdf:3:1: joint 'j2' has a velocity limit of -2, which is below 1e-06; "
                  "correct it there, or in a robot file: joints: [{name: j2, velocity_rad_s: 1}]"));
  EXPECT_THAT(
      problems_of(arm("revolute", "<limit lower='-1' upper='1' effort='1' velocity='1e-300'/>")),
      ElementsAre(HasSubstr("joint 'j2' has a velocity limit of 1e-300, which is below 1e-06; ")));
}

TEST_F(UrdfFile, IsJudgedWithTheLimitsThatARobotFileStatesInPlaceOfItsOwn) {
  write("arm.urdf", arm("revolute", "<limit effort='1' velocity='-2'/>"));
  const std::string head = "armature_robot: 1\nname: mine\nurdf: arm.urdf\ntip: hand\n";
  const auto said = [&](const std::string& rest) {
    return problems_when([&] { robot(head + rest); });
  };
  EXPECT_THAT(said(""), ElementsAre(HasSubstr("has no room to move: its limits are 0 to 0"),
                                    HasSubstr("has a velocity limit of -2")));
  EXPECT_THAT(said("joints: [{name: j2, velocity_rad_s: 3}]\n"),
              ElementsAre(HasSubstr("has no room to move")));
  EXPECT_THAT(said("joints: [{name: j2, limits_deg: [20, 10], velocity_rad_s: 3}]\n"),
              ElementsAre("arm.yaml:5:33: 'limits_deg' is [lower, upper], and 20 is not below 10"));
  const RobotModel repaired =
      robot(head + "joints: [{name: j2, limits_deg: [-90, 90], velocity_rad_s: 3}]\n");
  EXPECT_NEAR(repaired.upper()[1], std::numbers::pi / 2, 1e-15);
  EXPECT_EQ(repaired.max_velocity()[1], 3);
  EXPECT_EQ(repaired.max_acceleration()[1], 12);

  const RobotModel locked = robot(head + "joints: [{name: j2, locked: true}]\nhome: [0.5, 0]\n");
  EXPECT_EQ(locked.dof(), 1);
  EXPECT_THAT(said("joints: [{name: j2, locked: true}]\nhome: [0, 0.5]\n"),
              ElementsAre(HasSubstr("j2 = 28.64788976 deg is outside of 0 deg to 0 deg")));
}

TEST_F(UrdfFile, SaysWhichAxisAndWhichNumberIsNone) {
  EXPECT_THAT(problems_of(arm("revolute", kLimit + "<axis xyz='0 0 0'/>")),
              ElementsAre("arm.urdf:3:1: joint 'j2' has an axis without a usable length"));
  for (const char* number : {"nan", "inf", "1e999", "one"}) {
    const auto problems =
        problems_of(arm("revolute", kLimit + "<origin xyz='0 0 " + number + "' rpy='0 0 0'/>"));
    EXPECT_THAT(problems, ElementsAre(HasSubstr("arm.urdf:3:1: not a robot description that "
                                                "urdfdom reads: ")));
    EXPECT_THAT(problems, ElementsAre(HasSubstr(number)));
  }
}

// As in a robot file: millimetres, or degrees where radians are.
TEST_F(UrdfFile, WithALengthOrALimitThatNoRobotHasIsRefused) {
  EXPECT_THAT(problems_of(arm("revolute", kLimit + "<origin xyz='0 -300 0.5'/>")),
              ElementsAre("arm.urdf:3:1: joint 'j2' has its origin at 0, -300, 0.5, farther than "
                          "100 m; is it told in another unit?"));
  EXPECT_THAT(problems_of(arm("fixed", "<origin xyz='1e308 0 0'/>")),
              ElementsAre(HasSubstr("arm.urdf:3:1: joint 'j2' has its origin at 1e+308, 0, 0")));
  EXPECT_THAT(
      problems_of(arm("prismatic", "<limit lower='0' upper='400' effort='1' velocity='2'/>")),
      ElementsAre("arm.urdf:3:1: joint 'j2' has limits of 0 to 400 m, farther than 100 m; "
                  "correct it there, or in a robot file: joints: [{name: j2, limits_m: [0, "
                  "1]}]"));
  const std::string endless =
      arm("revolute", "<limit lower='-1e308' upper='1' effort='1' velocity='2'/>");
  EXPECT_THAT(problems_of(endless),
              ElementsAre(HasSubstr("has limits of -1e+308 to 1 rad, more than 1e+06 degrees; ")));
  EXPECT_EQ(robot("armature_robot: 1\nname: mine\nurdf: arm.urdf\ntip: hand\n"
                  "joints: [{name: j2, limits_deg: [-180, 180]}]\n")
                .upper()[1],
            std::numbers::pi);
  EXPECT_THAT(problems_of(arm("continuous", "<origin xyz='0 -100 0'/>")), ElementsAre());
}

TEST_F(UrdfFile, IsQuotedInPartsThatAScreenHolds) {
  const std::string long_number(1'000'000, '1');
  const auto problems =
      problems_of(arm("revolute", kLimit + "<origin xyz='0 0 " + long_number + "x'/>"));
  ASSERT_THAT(problems, ElementsAre(HasSubstr("arm.urdf:3:1: not a robot description that ")));
  EXPECT_LT(problems[0].size(), 1000u);
}

TEST_F(UrdfFile, SaysWhatUrdfdomWouldDropAndTakeADefaultFor) {
  const auto said = [&](const std::string& inside) {
    return problems_of(arm("revolute", kLimit + "\n" + inside));
  };
  const std::string in = "arm.urdf:4:1: joint 'j2' has ";
  EXPECT_THAT(
      said("<origin xzy='0 0 0.1'/>"),
      ElementsAre(in + "'xzy' in its <origin>, which is none of URDF; did you mean 'xyz'?"));
  EXPECT_THAT(
      said("<origin quat_xyzw='0 0 0 1'/>"),
      ElementsAre(in + "'quat_xyzw' in its <origin>, which is none of URDF; known: xyz, rpy"));
  EXPECT_THAT(
      said("<orign xyz='0 0 0.1'/>"),
      ElementsAre(in + "an element <orign>, which is none of URDF; did you mean 'origin'?"));
  EXPECT_THAT(said("<axes xyz='0 0 1'/>"),
              ElementsAre(in + "an element <axes>, which is none of URDF; did you mean 'axis'?"));
  EXPECT_THAT(said("<mimic joint='j1' multiplyer='-1'/>"),
              ElementsAre(in + "'multiplyer' in its <mimic>, which is none of URDF; did you mean "
                               "'multiplier'?"));
  EXPECT_THAT(said("<axis xyz='0 0 1'/><axis xyz='0 1 0'/>"),
              ElementsAre(in + "a second <axis>, and only the first is read"));
  EXPECT_THAT(said(kLimit), ElementsAre(in + "a second <limit>, and only the first is read"));
  EXPECT_THAT(
      problems_of(arm("prismatic", "\n<limit lowr='-1' upper='1' effort='1' velocity='2'/>")),
      ElementsAre(in + "'lowr' in its <limit>, which is none of URDF; did you mean 'lower'?"));
}

TEST_F(UrdfFile, MayHoldWordsOfOthersAndLeaveOutWhatUrdfHasADefaultFor) {
  EXPECT_THAT(problems_of(arm("revolute",
                              "<limit lower='-1' upper='1' effort='1' velocity='2' "
                              "acceleration='3' drake:acceleration='3'/>"
                              "<hardwareInterface>EffortJointInterface</hardwareInterface>"
                              "<drake:origin/><dynamics damping='0.1' armature='0.2'/>"
                              "<safety_controller k_velocity='10' soft_lower_limit='-1'/>"
                              "<calibration rising='0'/>")),
              ElementsAre());
}

TEST_F(UrdfFile, SaysWhatAMimickingJointCannotFollow) {
  const auto mimic = [](const std::string& what) { return kLimit + "<mimic " + what + "/>"; };
  EXPECT_THAT(problems_of(arm("revolute", mimic("joint='j1'")), "l1"),
              ElementsAre("arm.urdf:3:1: joint 'j2' mimics 'j1', which does not move between 'l1' "
                          "and 'hand'; take a base and a tip with both between them"));
  EXPECT_THAT(problems_of(arm("revolute", mimic("joint='j2'"))),
              ElementsAre("arm.urdf:3:1: joint 'j2' cannot mimic 'j2', which mimics another joint "
                          "itself; name the one that moves by itself"));
  EXPECT_THAT(problems_of(arm("revolute", mimic("joint='j1' multiplier='0'"))),
              ElementsAre("arm.urdf:3:1: joint 'j2' mimics with a multiplier of 0, nearer to 0 "
                          "than 1e-06; a joint that does not move is fixed"));
  EXPECT_THAT(problems_of(arm("revolute", mimic("joint='j1' multiplier='-1e308'"))),
              ElementsAre("arm.urdf:3:1: joint 'j2' mimics with a multiplier of -1e+308, more than "
                          "1e+06; is it told in another unit?"));
  EXPECT_THAT(problems_of(arm("revolute", mimic("joint='j1' offset='1e308'"))),
              ElementsAre("arm.urdf:3:1: joint 'j2' mimics with an offset of 1e+308 rad, more than "
                          "1e+06 degrees; is it told in another unit?"));
  EXPECT_THAT(problems_of(arm("prismatic", mimic("joint='j1' offset='400'"))),
              ElementsAre("arm.urdf:3:1: joint 'j2' mimics with an offset of 400 m, farther than "
                          "100 m; is it told in another unit?"));
}

TEST_F(UrdfFile, SaysWhichMimickingJointCanNeverKeepItsLimits) {
  const auto mimic = [](const std::string& what) {
    return "<limit lower='0.5' upper='1' effort='1' velocity='2'/><mimic joint='j1' " + what + "/>";
  };
  EXPECT_THAT(problems_of(arm("revolute", mimic("multiplier='-1' offset='-1'"))),
              ElementsAre("arm.urdf:3:1: joint 'j2' mimics 'j1', which has no room to move: its "
                          "limits and those of the joints that follow it exclude each other; "
                          "correct the limits, the multiplier or the offset"));
  EXPECT_THAT(problems_of(arm("revolute", mimic("multiplier='-1'"))), ElementsAre());
}

TEST_F(UrdfFile, WithEntitiesSaysWhatResolvesThem) {
  const std::string head = "<?xml version='1.0'?>\n<!-- no <!DOCTYPE robot [ here -->\n";
  const std::string inside = arm("revolute", kLimit);
  EXPECT_THAT(problems_of(head + "<!DOCTYPE robot [\n<!ENTITY far '1'>]>\n" + inside),
              ElementsAre("arm.urdf:3:1: declarations in a document type, such as entities, are "
                          "not read; run 'xmllint --noent --dropdtd arm.urdf > resolved.urdf', and "
                          "name that"));
  EXPECT_THAT(problems_of(head + "<!DOCTYPE robot>\n" + inside), ElementsAre());
}

TEST_F(UrdfFile, ThatIsNoneIsRefusedWithItsLine) {
  EXPECT_THAT(problems_of("<robot name='arm'>\n<link name='a'>\n</robot>\n"),
              ElementsAre(HasSubstr("arm.urdf:2:1: not XML (XML_ERROR_MISMATCHED_ELEMENT)")));
  EXPECT_THAT(problems_of(""), ElementsAre(HasSubstr("not XML (XML_ERROR_EMPTY_DOCUMENT)")));
  EXPECT_THAT(problems_of("<sdf/>"),
              ElementsAre(HasSubstr("arm.urdf:1:1: not a robot description")));
  EXPECT_THAT(problems_of("<robot name='arm'/>"), ElementsAre(HasSubstr("arm.urdf: not a robot")));
  EXPECT_THAT(problems_when([&] {
                load_urdf_robot(folder_ / "none.urdf", {}, {"hand", {}});
              }),
              ElementsAre(HasSubstr("none.urdf': No such file or directory")));
}

TEST_F(UrdfFile, ThatIsNotThereIsToldWhereARobotFileNamesIt) {
  EXPECT_THAT(
      problems_when([&] { robot("armature_robot: 1\nname: mine\nurdf: none.urdf\ntip: hand\n"); }),
      ElementsAre(::testing::AllOf(HasSubstr("arm.yaml:3:7: cannot read '"),
                                   HasSubstr("none.urdf': No such file or directory"))));
}

TEST_F(UrdfFile, InARobotFileBringsJointsAndLinksToWhichTheFileAdds) {
  write("arm.urdf", arm("continuous", ""));
  const RobotModel made = robot(
      "armature_robot: 1\n"
      "name: mine\n"
      "urdf: arm.urdf\n"
      "tip: hand\n"
      "joints:\n"
      "  - {name: j1, acceleration_rad_s2: 3}\n"
      "  - {name: j2, velocity_rad_s: 5}\n"
      "frames: {tool: {parent: l1, translation_m: [1, 2, 3]}}\n"
      "pointing_axis: z\n"
      "home: [0.5, 6]\n");
  EXPECT_EQ(made.name(), "mine");
  EXPECT_EQ(made.max_acceleration()[0], 3);
  EXPECT_EQ(made.max_velocity()[0], 2);
  EXPECT_EQ(made.max_velocity()[1], 5);
  EXPECT_EQ(made.max_acceleration()[1], 20);
  EXPECT_EQ(made.frame(made.tool()).name, "tool");
  EXPECT_EQ(made.frame(made.tool()).parent_joint, 0);
  EXPECT_EQ(resting_position(made), testing::joint_vector({0.5, 6}));
}

TEST_F(UrdfFile, InARobotFileIsTheSameArmAsByItself) {
  const std::string file = (kData / "skew_puma.urdf").string();
  const RobotModel made =
      robot("armature_robot: 1\nname: puma\nurdf: " + file + "\nbase: foot\ntip: tool0\n");
  const RobotModel alone = load("skew_puma", "foot", "tool0");
  std::mt19937 random{5};
  for (int i = 0; i < 10; ++i) {
    const JointVector q = testing::random_joints(made, random);
    EXPECT_TRUE(forward_kinematics(made, q).matrix() == forward_kinematics(alone, q).matrix());
  }
}

TEST_F(UrdfFile, InARobotFileIsHeldToWhatMotionNeedsAndToItsWords) {
  write("arm.urdf", arm("continuous", ""));
  const std::string head = "armature_robot: 1\nname: mine\nurdf: arm.urdf\n";
  const auto said = [&](const std::string& rest) {
    return problems_when([&] { robot(head + rest); });
  };
  EXPECT_THAT(said("tip: hand\n"),
              ElementsAre("arm.yaml:3:7: joint 'j2' has no velocity limit; state it in the URDF "
                          "file, or here: joints: [{name: j2, velocity_rad_s: 1}]"));
  EXPECT_THAT(said("tip: hadn\n"), ElementsAre("arm.yaml:4:6: there is no link 'hadn' in arm.urdf; "
                                               "did you mean 'hand'?"));
  EXPECT_THAT(said(""), ElementsAre(HasSubstr("'tip'")));
  EXPECT_THAT(said("tip: hand\njoints: [{name: j3, velocity_rad_s: 1}, {name: j2, velocity_rad_s: "
                   "1}]\nframes: {hand: {parent: l1}, eye: {parent: l2}}\n"),
              ElementsAre(HasSubstr("there is no joint 'j3'"),
                          "arm.yaml:6:10: 'hand' is the name of a link; a frame needs its own",
                          HasSubstr("there is no link or frame 'l2'")));
  EXPECT_THAT(said("tip: hand\njoints: [{name: j2, velocity_rad_s: 1}, {name: j2, locked: true}]\n"
                   "home_deg: [0, 0]\n"),
              ElementsAre("arm.yaml:5:48: there is a joint 'j2' already"));
}

// tinyxml2 and urdfdom read such a file, browsers and other strict parsers refuse it.
TEST(ShippedUrdfFiles, HaveNoTwoHyphensInAComment) {
  for (const auto& file :
       std::filesystem::directory_iterator{ARMATURE_SOURCE_DIR "/configs/robots"}) {
    if (file.path().extension() != ".urdf") continue;
    const std::string text = content_of(file.path());
    for (std::size_t begin = text.find("<!--"); begin != std::string::npos;
         begin = text.find("<!--", begin)) {
      begin += 4;
      EXPECT_EQ(text.find("--", begin), text.find("-->", begin)) << file.path();
    }
  }
}

}  // namespace
}  // namespace armature
