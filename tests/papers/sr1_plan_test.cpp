// SPDX-License-Identifier: Apache-2.0
// SR-1, the plan: how near the needle comes to what it must not touch.
#include <gtest/gtest.h>

#include "armature/config/problems.hpp"
#include "armature/kinds/path/path.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "reference_file.hpp"

namespace armature::paper {
namespace {

constexpr double kNeedleRadius = 0.001;  // [m]

ForbiddenZone sphere(const Figures& zone) {
  const Eigen::Vector3d center = zone["center"].point_m();
  return {"zone", center, center, 1e-3 * zone["radius"].number()};
}

TEST(Sr1Plan, HasTheDepthAndTheClearancesOfTheReference) {
  const Figures plan = sr1()["plan"];
  const Eigen::Vector3d entry = plan["entry"].point_m(), target = plan["target"].point_m();
  EXPECT_NEAR(1e3 * (target - entry).norm(), plan["depth"].number(), 1e-11);
  EXPECT_LT(((target - entry).normalized() - plan["direction"].numbers()).norm(), 1e-11);
  ASSERT_EQ(plan["zones"].size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const Figures zone = plan["zones"][i];
    EXPECT_NEAR(1e3 * (clearance(entry, target, sphere(zone)) - kNeedleRadius),
                zone["clearance_with_needle_radius_1.0"].number(), 1e-11);
  }
}

TEST(Sr1Plan, PathNeedleRefusesTheZoneThatIsTooNearAndTakesTheOther) {
  const Figures figures = sr1()["plan"];
  const Eigen::Vector3d entry = figures["entry"].point_m(), target = figures["target"].point_m();
  config::Problems problems;
  const std::string id = "path/needle";
  const RobotModel robot = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/sr1_needle.yaml");
  const Params defaults = Params::read(built_plugins().find(id)->params, nullptr, id, problems);
  const auto planner = *built_plugins().make<PathPlanner>(id, robot, defaults);
  const Direction along{(target - entry).normalized()};
  PathRequest request{.start = {entry - 0.2 * along.unit, Direction{{0, 0, 1}}},
                      .goal = {target, along},
                      .focus = entry};
  for (std::size_t i = 0; i < 2; ++i) {
    const Figures zone = figures["zones"][i];
    request.forbidden = {sphere(zone)};
    EXPECT_EQ(!planner->plan(request), zone["violates_margin_2.0"].text() == "true") << i;
  }
}

}  // namespace
}  // namespace armature::paper
