// SPDX-License-Identifier: Apache-2.0
#include "any_arm.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <kdl/chainfksolverpos_recursive.hpp>

#include "armature/robot/kinematics/kdl_chain_test.hpp"

namespace armature::test {
namespace {

std::string text(const Numbers& numbers) { return fmt::format("{:.17g}", fmt::join(numbers, " ")); }

std::string text(const KDL::Vector& point) {
  return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", point.x(), point.y(), point.z());
}

}  // namespace

Numbers Lot::three(double most) {
  return {between(-most, most), between(-most, most), between(-most, most)};
}

AnyArm::AnyArm(Lot& lot, int count) {
  for (int i = 0; i < count; ++i) add_joint(lot, i);
  tip = fmt::format("l{}", count);
  urdf = fmt::format("<robot name=\"any\"><link name=\"l0\"/>{}</robot>", urdf);
  chain = testing::kdl_chain_of_urdf(*urdf::parseURDF(urdf), "l0", tip);
}

void AnyArm::add_joint(Lot& lot, int i) {
  const auto* word = lot.one_of(Words{"joint ", "1e", "j: ", "[", "it's ", "ä#", "-"});
  const std::string name = i == 0 ? "first" : word + std::to_string(i);
  const std::string any = lot.one_of(Words{"revolute", "continuous", "prismatic"}),
                    type = i == 0 || lot.below(3) == 0 ? "revolute" : any;
  const bool slides = type == "prismatic", follows = i > 0 && !slides && lot.below(5) == 0;
  const double range = slides ? lot.between(0.02, 0.6) : lot.one_of({0.3, 2.0, 5.0, 12.0});
  const double lower =
      lot.one_of({-range / 2, lot.between(-1, 1), lot.between(-1, 1) * (slides ? 1 : 40)});
  const double speed = range * std::pow(10, lot.between(-0.8, 0.8));
  AnyJoint joint{lower, lower + range, speed, type != "continuous"};
  ratios.push_back(follows ? lot.one_of({-1.0, 0.5, -0.37, 2.3}) : 0);
  home.push_back(follows ? ratios.back() * home[0] : lower + range * lot.between(0.05, 0.95));
  if (!follows) joints.push_back(joint);
  if (follows) joint = {-1e4, 1e4, 1e4, true};  // the first one's limits are narrower
  const Numbers place = lot.three(0.3), turn = lot.three(3),
                axis = lot.three(lot.one_of({0.01, 1.0, 40.0}));
  urdf += fmt::format(
      R"(<joint name="{0}" type="{1}"><parent link="l{2}"/><child link="l{3}"/>
<origin xyz="{4}" rpy="{5}"/><axis xyz="{6}"/><limit lower="{7:.17g}" upper="{8:.17g}"
effort="1" velocity="{9:.17g}"/>{10}</joint><link name="l{3}"/>
)",
      name, type, i, i + 1, text(place), text(turn), text(axis), joint.lower, joint.upper,
      joint.speed,
      follows ? fmt::format(R"(<mimic joint="first" multiplier="{}"/>)", ratios.back()) : "");
}

KDL::Frame AnyArm::frame(int link, const double* q) const {
  KDL::JntArray every(chain.getNrOfJoints());
  const double first = *q;
  for (unsigned i = 0; i < every.rows(); ++i) {
    every(i) = ratios[i] == 0 ? *q++ : ratios[i] * first;
  }
  KDL::Frame at;
  EXPECT_EQ(KDL::ChainFkSolverPos_recursive{chain}.JntToCart(every, at, link), 0);
  return at;
}

KDL::Frame AnyArm::tool(const double* q) const {
  return frame(static_cast<int>(chain.getNrOfSegments()), q);
}

void AnyArm::draw_bodies(Lot& lot) {
  for (int link = 0; link <= static_cast<int>(chain.getNrOfSegments()); ++link) {
    const Numbers from = lot.three(0.1), to = lot.three(0.2);
    bodies.push_back({link,
                      {from[0], from[1], from[2]},
                      {to[0], to[1], to[2]},
                      lot.one_of({0.001, 0.02, 0.05})});
  }
}

void AnyArm::write(const TemporaryFolder& folder) const {
  std::ofstream{folder / "arm.urdf"} << urdf;
  std::ofstream robot{folder / "arm.yaml"};
  robot << fmt::format("armature_robot: 1\nname: any\nurdf: arm.urdf\ntip: {}\nhome: [{:.17g}]\n",
                       tip, fmt::join(home, ", "));
  if (!bodies.empty()) robot << "capsules:\n";
  for (const AnyBody& body : bodies) {
    robot << fmt::format("  body {0}: {{parent: {1}, from_m: {2}, to_m: {3}, radius_m: {4}}}\n",
                         body.link, body.link == 0 ? "base" : fmt::format("l{}", body.link),
                         text(body.from), text(body.to), body.radius);
  }
}

}  // namespace armature::test
