// SPDX-License-Identifier: Apache-2.0
// Arms that nobody has built, on tours: in no period a joint passes a limit, every goal is reached
// by the kinematics of KDL, and one that is far away is refused as such. ARMATURE_ARMS: so many,
// from number ARMATURE_FIRST_ARM on; `tools/test --full` has others every day.
#include "any_arm.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <sstream>

#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"
#include "deployment_run.hpp"
#include "tests/environment_number.hpp"

namespace armature::test {
namespace {

/// An arm of 3 to 8 joints, and its tour.
struct AnyTour {
  explicit AnyTour(int seed) : lot{seed}, is_far{seed % 5 == 0}, arm{lot, 3 + lot.below(6)} {
    set_out(seed);
  }
  void set_out(int seed);

  Lot lot;
  bool is_far;  // the last goal
  AnyArm arm;
  std::vector<KDL::Frame> goals;
  std::vector<std::string> settings;
};

void AnyTour::set_out(int seed) {
  Numbers positions_mm, rpy_deg;
  for (int i = 0; i < 3; ++i) {
    Numbers q;
    for (const AnyJoint& joint : arm.joints) {
      q.push_back(joint.lower + (joint.upper - joint.lower) * lot.between(0.05, 0.95));
    }
    KDL::Frame& goal = goals.emplace_back(arm.tool(q.data()));
    if (i == 2 && is_far) goal.p.x(50);
    double rpy[3];
    goal.M.GetRPY(rpy[0], rpy[1], rpy[2]);
    for (const double length : goal.p.data) positions_mm.push_back(1e3 * length);
    for (const double angle : rpy) rpy_deg.push_back(angle * 180 / M_PI);
  }
  const double period_s = lot.one_of({0.0005, 0.001, 0.002, 0.005, 0.02});
  const bool is_led = lot.below(3) == 0;  // by somebody who pauses it
  const auto* path = lot.one_of(Words{"joint_move", "orientations"});
  const auto* trajectory =
      lot.one_of(Words{"quintic", "quintic_spline", "cubic_spline", "sampled"});
  settings = {
      fmt::format("components.task.params.positions_mm=[{:.17g}]", fmt::join(positions_mm, ", ")),
      fmt::format("components.task.params.rpy_deg=[{:.17g}]", fmt::join(rpy_deg, ", ")),
      fmt::format("components.task.params.auto_confirm={}", !is_led),
      fmt::format("components.operator.params.words={}", is_led ? 12 : 0),
      fmt::format("components.operator.params.seed={}", seed),
      fmt::format("components.motion.path.plugin=path/{}", path),
      fmt::format("components.motion.trajectory.plugin=trajectory/{}", trajectory),
      fmt::format("components.motion.params.rate_hz={}", 1 / period_s),
      fmt::format("components.arm.params.rate_hz={}", 1 / period_s),
      fmt::format("executors.control.period_s={}", period_s)};
}

/// In every row: the time [ns], and q, v and a of the joints that move by themselves.
void expect_limits_and_goals(const AnyTour& tour, std::string reference) {
  constexpr double kOfALimit = 1.001, kBeyond = 1e-6;  // what motion allows a trajectory
  const AnyArm& arm = tour.arm;
  const std::size_t dof = arm.joints.size();
  Numbers missed(tour.is_far ? 2 : 3, 1e9);
  std::ranges::replace(reference, ',', ' ');
  std::istringstream rows{reference};
  for (std::string text; std::getline(rows, text);) {
    std::istringstream numbers{text};
    const Numbers row{std::istream_iterator<double>{numbers}, {}};
    ASSERT_EQ(row.size(), 1 + 3 * dof);
    const double *q = &row[1], *v = q + dof, *a = v + dof;
    double fastest = 0;
    for (std::size_t i = 0; i < dof; ++i) {
      const AnyJoint& joint = arm.joints[i];
      const double beyond = std::max(joint.lower - q[i], q[i] - joint.upper);
      const double faster = std::max(std::abs(v[i]), 0.25 * std::abs(a[i])) / joint.speed;
      ASSERT_TRUE((!joint.ends || beyond <= kBeyond) && faster <= kOfALimit)
          << "joint " << i << " of " << text;
      fastest = std::max(fastest, std::abs(v[i]));
    }
    for (std::size_t i = 0; i < missed.size() && fastest < 1e-12; ++i) {
      const KDL::Twist miss = KDL::diff(arm.tool(q), tour.goals[i]);
      missed[i] = std::min(missed[i], miss.vel.Norm() + miss.rot.Norm());
    }
  }
  for (const double miss : missed) EXPECT_LT(miss, 3e-6);
}

TEST(AnyArmOnATour, KeepsItsLimitsAndReachesItsGoals) {
  const int first = environment_number("ARMATURE_FIRST_ARM", 1),
            count = environment_number("ARMATURE_ARMS", 5);
  for (int seed = first; seed < first + count; ++seed) {
    const AnyTour tour{seed};
    const TemporaryFolder folder;
    tour.arm.write(folder);
    DeploymentStart start{.files = {source_file("tests/by_lot/any_arm.yaml")},
                          .settings = tour.settings};
    start.options.environment = {{"ARMATURE_PLUGIN_PATH", TEST_PLUGINS},
                                 {"ARM_FOLDER", folder.path()}};
    const DeploymentRun run = run_deployment(start);
    SCOPED_TRACE(fmt::format("ARMATURE_FIRST_ARM={} ARMATURE_ARMS=1\n{}\n{}\n{}", seed,
                             tour.arm.urdf, fmt::join(tour.settings, "\n"), run.text()));
    EXPECT_EQ(run.status(), tour.is_far ? "refused" : "ok");
    EXPECT_EQ(run.word("reason").starts_with("waypoint 3: ik: the goal: out_of_reach"),
              tour.is_far);
    expect_limits_and_goals(tour, content_of(folder / "reference.csv"));
  }
}

}  // namespace
}  // namespace armature::test
