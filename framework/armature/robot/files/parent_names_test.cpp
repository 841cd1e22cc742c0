// SPDX-License-Identifier: Apache-2.0
// What `parent:` means beside a URDF file: the link of that name, or the user's frame.
#include "armature/robot/files/parent_names.hpp"

#include <gmock/gmock.h>

#include <array>

#include "armature/robot/files/urdf_file_test.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/model/test_robots.hpp"

namespace armature {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kRange = "<limit lower='-2' upper='2' effort='1' velocity='1'/></joint>\n";
const std::string kArm =
    "<robot name='arm'><link name='foot'/>\n"
    "<joint name='turn' type='revolute'><parent link='foot'/><child link='column'/>"
    "<origin xyz='0 0.15 0.2'/><axis xyz='0 0 1'/>" +
    kRange +
    "<link name='column'/>\n"
    "<joint name='elbow' type='revolute'><parent link='column'/><child link='elbow'/>"
    "<origin xyz='0.3 0.1 0'/><axis xyz='0 1 0'/>" +
    kRange +
    "<link name='elbow'/>\n"
    "<joint name='wrist' type='revolute'><parent link='elbow'/><child link='palm'/>"
    "<origin xyz='0.02 0 -0.4'/><axis xyz='0 0 -1'/>" +
    kRange +
    "<link name='palm'/>\n"
    "<joint name='plate' type='fixed'><parent link='palm'/><child link='hand'/>"
    "<origin xyz='0 0 -0.1'/></joint><link name='hand'/>\n"
    "<joint name='post' type='fixed'><parent link='foot'/><child link='camera'/>"
    "<origin xyz='1 0 0'/></joint><link name='camera'/>\n"
    "</robot>\n";

/// An arm whose joints do not turn about the z of their links, so that Denavit-Hartenberg frames
/// are other frames than the links'.
class UrdfParents : public testing::UrdfFile {
 protected:
  UrdfParents() { write("arm.urdf", kArm); }
  RobotModel with(const std::string& rest) const { return robot(kHead + rest); }
  std::vector<std::string> problems_with(const std::string& rest) const {
    return problems_when([&] { with(rest); });
  }

  const std::string kHead = "armature_robot: 1\nname: mine\nurdf: arm.urdf\ntip: hand\n";
};

const Eigen::Vector3d kPoint{0.1, 0.2, 0.3};  // of a frame
const std::string kAt = ", from_m: [0.1, 0.2, 0.3], to_m: [0.1, 0.2, 0.3], radius_m: 0.1}";

/// Where a point that was read as hanging on a joint is, less where it is by its frame's pose.
double apart(const RobotModel& robot, int joint, const Eigen::Vector3d& joint_p_point,
             const std::string& frame) {
  const JointVector q = testing::joint_vector({0.3, -0.5, 0.7});
  std::array<Eigen::Isometry3d, kMaxJoints> base_T_joint;
  joint_frames(robot, q, base_T_joint);
  const Eigen::Vector3d is = base_T_joint[static_cast<std::size_t>(joint)] * joint_p_point;
  return (is - forward_kinematics(robot, q, *robot.find_frame(frame)) * kPoint).norm();
}

TEST_F(UrdfParents, ALinkIsTheFrameOfTheUrdfFileAlsoWhereAJointHasItsName) {
  const RobotModel robot =
      with("capsules:\n  a: {parent: elbow" + kAt + "\n  b: {parent: column" + kAt +
           "\nmasses: {c: {parent: elbow, centre_m: [0.1, 0.2, 0.3], " + "mass_kg: 2}}\n");
  const auto& capsules = robot.capsules();
  EXPECT_LT(apart(robot, capsules[0].parent_joint, capsules[0].from, "elbow"), 1e-12);
  EXPECT_LT(apart(robot, capsules[1].parent_joint, capsules[1].to, "column"), 1e-12);
  const LinkMass& mass = robot.masses()[0];
  EXPECT_LT(apart(robot, mass.parent_joint, mass.centre, "elbow"), 1e-12);
}

TEST_F(UrdfParents, AFrameOfTheUsersMayHaveTheNameOfAJoint) {
  const RobotModel robot = with(
      "frames:\n  lens: {parent: wrist}\n"
      "  wrist: {parent: hand, translation_m: [0, 0.5, 0]}\n"
      "capsules: {a: {parent: wrist" +
      kAt + "}\n");
  const LinkCapsule& capsule = robot.capsules()[0];
  EXPECT_LT(apart(robot, capsule.parent_joint, capsule.from, "wrist"), 1e-12);
  EXPECT_LT(apart(robot, capsule.parent_joint, capsule.from, "lens"), 1e-12);
}

TEST_F(UrdfParents, AJointsNameIsNoneAndTheLinkThatItCarriesIsNamed) {
  EXPECT_THAT(
      problems_with("frames: {f: {parent: wrist}}\ncapsules: {a: {parent: turn" + kAt +
                    "}\nmasses: {c: {parent: plate, centre_m: [0, 0, 0], mass_kg: 2}}\n"),
      ElementsAre("arm.yaml:5:22: 'wrist' is a joint of arm.urdf; name the link that it carries: "
                  "'palm'",
                  "arm.yaml:6:24: 'turn' is a joint of arm.urdf; name the link that it carries: "
                  "'column'",
                  "arm.yaml:7:22: 'plate' is a joint of arm.urdf; name the link that it carries: "
                  "'hand'"));
}

TEST_F(UrdfParents, ALinkBesideTheArmIsNoneAndUnknownNamesAreNoLinks) {
  EXPECT_THAT(
      problems_with("frames: {f: {parent: camera}}\ncapsules: {a: {parent: colum" + kAt + "}\n"),
      ElementsAre("arm.yaml:5:22: 'camera' is a link of arm.urdf that does not lie between 'foot', "
                  "on which the arm stands, and 'hand'; name one that does",
                  "arm.yaml:6:24: there is no link or frame 'colum'; did you mean 'column'?"));
}

TEST_F(UrdfParents, BaseIsTheLinkThatTheArmStandsOnOrNone) {
  const auto renamed = [](const std::string& link) {
    std::string text = kArm;
    for (auto at = text.find("'" + link + "'"); at != text.npos; at = text.find("'" + link + "'"))
      text.replace(at + 1, link.size(), "base");
    return text;
  };
  const std::string hung = "frames: {lamp: {parent: base, translation_m: [0, 0, 0.1]}}\n";
  write("arm.urdf", renamed("foot"));
  const RobotModel robot = with(hung);
  EXPECT_EQ(robot.frame(*robot.find_frame("lamp")).parent_joint, -1);

  write("arm.urdf", renamed("column"));
  const std::string two =
      "'base' would be two things: what the arm stands on, which is 'foot', and a link of arm.urdf "
      "that hangs on it; stand the arm on that link (base: base, or --base base), or give it "
      "another name";
  EXPECT_THAT(problems_with(""), ElementsAre("arm.yaml:3:7: " + two));
  EXPECT_THAT(problems_of(renamed("column")), ElementsAre("--base: " + two));
  EXPECT_THAT(problems_of(renamed("column"), "base"), ElementsAre());

  write("arm.urdf", renamed("camera"));
  EXPECT_THAT(problems_with(""), ElementsAre());
  EXPECT_THAT(problems_with(hung), ElementsAre(HasSubstr("'base' is a link of arm.urdf that does "
                                                         "not lie between 'foot', on which")));
}

TEST_F(UrdfParents, TheToolIsTheTipUnlessALinkOrAFrameHasThatName) {
  const RobotModel robot = with("capsules: {a: {parent: tool" + kAt + "}\n");
  const LinkCapsule& capsule = robot.capsules()[0];
  EXPECT_LT(apart(robot, capsule.parent_joint, capsule.from, "hand"), 1e-12);
  EXPECT_LT(apart(robot, capsule.parent_joint, capsule.from, "tool"), 1e-12);
  EXPECT_EQ(robot.frame(robot.tool()).name, "hand");

  const RobotModel pen = with(
      "frames: {tool: {parent: hand, translation_m: [0, 0, 0.2]}}\n"
      "capsules: {a: {parent: tool" +
      kAt + "}\n");
  EXPECT_EQ(pen.tool(), *pen.find_frame("tool"));
  EXPECT_LT(apart(pen, pen.capsules()[0].parent_joint, pen.capsules()[0].from, "tool"), 1e-12);

  std::string text = kArm;
  text.replace(text.rfind("'camera'"), 8, "'tool'");
  text.replace(text.find("'camera'"), 8, "'tool'");
  write("arm.urdf", text);
  EXPECT_FALSE(with("").find_frame("tool"));
}

// What is wrong is the URDF file, or the list of joints: of every parent it was said that there is
// no such link, too.
TEST_F(UrdfParents, AreNotJudgedByLinksThatCouldNotBeRead) {
  const std::string bodies =
      "frames: {eye: {parent: palm}}\ncapsules: {arm: {parent: elbow" + kAt + "}\n";
  EXPECT_THAT(problems_with(bodies), ElementsAre());
  const auto said = [&](const std::string& head) {
    return problems_when([&] { robot(head + bodies); });
  };
  const std::string head = "armature_robot: 1\nname: mine\n";
  EXPECT_THAT(said(head + "urdf: arm.urdf\ntip: hadn\n"),
              ElementsAre(HasSubstr("there is no link 'hadn'")));
  EXPECT_THAT(said(head + "urdf: arm.urdf\n"), ElementsAre(HasSubstr("missing key 'tip'")));
  EXPECT_THAT(said(head + "joints: 6\n"), ElementsAre(HasSubstr("must be a list of joints")));
  write("arm.urdf", "<robot name='arm'><link name='foot'></robot>\n");
  EXPECT_THAT(problems_with(bodies), ElementsAre(HasSubstr("arm.urdf:1:1: not XML")));
}

}  // namespace
}  // namespace armature
