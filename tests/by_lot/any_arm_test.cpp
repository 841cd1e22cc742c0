// SPDX-License-Identifier: Apache-2.0
// Arms that nobody has built, on tours: in no period a joint passes a limit, every goal is reached
// by the kinematics of KDL, and one that is far away is refused as such. ARMATURE_ARMS: so many,
// from number ARMATURE_FIRST_ARM on; `tools/test --full` has others every day.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <random>
#include <sstream>

#include "armature/robot/kinematics/kdl_chain_test.hpp"
#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"
#include "deployment_run.hpp"
#include "tests/environment_number.hpp"

namespace armature::test {
namespace {

using Numbers = std::vector<double>;
using Words = std::initializer_list<const char*>;

/// A joint that moves by itself, [rad] or [m]. It reaches its speed in 0.25 s.
struct AnyJoint {
  double lower, upper, speed;
  bool ends;
};

/// An arm of 3 to 8 joints, and its tour.
struct AnyArm {
  explicit AnyArm(int seed) : chance(seed), is_far{seed % 5 == 0} {
    const int count = 3 + below(6);
    for (int i = 0; i < count; ++i) add_joint(i);
    tip = fmt::format("l{}", count);
    urdf = fmt::format("<robot name=\"any\"><link name=\"l0\"/>{}</robot>", urdf);
    chain = testing::kdl_chain_of_urdf(*urdf::parseURDF(urdf), "l0", tip);
    set_out(seed);
  }
  void add_joint(int i);
  void set_out(int seed);

  double between(double from, double to) {
    return from + (to - from) * static_cast<double>(chance() >> 11) * 0x1p-53;
  }
  int below(int count) { return static_cast<int>(between(0, count)); }
  template <class T>
  T one_of(std::initializer_list<T> values) {
    return values.begin()[below(static_cast<int>(values.size()))];
  }
  std::string three(double most) {
    const Numbers numbers{between(-most, most), between(-most, most), between(-most, most)};
    return fmt::format("{:.17g}", fmt::join(numbers, " "));
  }
  /// With the joints at `q`, which the others follow.
  KDL::Frame tool(const double* q) const {
    KDL::JntArray every(chain.getNrOfJoints());
    const double first = *q;
    for (unsigned i = 0; i < every.rows(); ++i) {
      every(i) = ratios[i] == 0 ? *q++ : ratios[i] * first;
    }
    KDL::Frame at;
    EXPECT_EQ(KDL::ChainFkSolverPos_recursive{chain}.JntToCart(every, at), 0);
    return at;
  }

  std::mt19937_64 chance;
  bool is_far;  // the last goal
  std::string urdf, tip;
  std::vector<AnyJoint> joints;
  Numbers home, ratios;  // of all, to the first one; 0: it moves by itself
  KDL::Chain chain;
  std::vector<KDL::Frame> goals;
  std::vector<std::string> settings;
};

void AnyArm::add_joint(int i) {
  const auto* word = one_of(Words{"joint ", "1e", "j: ", "[", "it's ", "ä#", "-"});
  const std::string name = i == 0 ? "first" : word + std::to_string(i);
  const std::string any = one_of(Words{"revolute", "continuous", "prismatic"}),
                    type = i == 0 || below(3) == 0 ? "revolute" : any;
  const bool slides = type == "prismatic", follows = i > 0 && !slides && below(5) == 0;
  const double range = slides ? between(0.02, 0.6) : one_of({0.3, 2.0, 5.0, 12.0});
  const double lower = one_of({-range / 2, between(-1, 1), between(-1, 1) * (slides ? 1 : 40)});
  const double speed = range * std::pow(10, between(-0.8, 0.8));
  AnyJoint joint{lower, lower + range, speed, type != "continuous"};
  ratios.push_back(follows ? one_of({-1.0, 0.5, -0.37, 2.3}) : 0);
  home.push_back(follows ? ratios.back() * home[0] : lower + range * between(0.05, 0.95));
  if (!follows) joints.push_back(joint);
  if (follows) joint = {-1e4, 1e4, 1e4, true};  // the first one's limits are narrower
  const std::string place = three(0.3), turn = three(3), axis = three(one_of({0.01, 1.0, 40.0}));
  urdf += fmt::format(
      R"(<joint name="{0}" type="{1}"><parent link="l{2}"/><child link="l{3}"/>
<origin xyz="{4}" rpy="{5}"/><axis xyz="{6}"/><limit lower="{7:.17g}" upper="{8:.17g}"
effort="1" velocity="{9:.17g}"/>{10}</joint><link name="l{3}"/>
)",
      name, type, i, i + 1, place, turn, axis, joint.lower, joint.upper, joint.speed,
      follows ? fmt::format(R"(<mimic joint="first" multiplier="{}"/>)", ratios.back()) : "");
}

void AnyArm::set_out(int seed) {
  Numbers positions_mm, rpy_deg;
  for (int i = 0; i < 3; ++i) {
    Numbers q;
    for (const AnyJoint& joint : joints) {
      q.push_back(joint.lower + (joint.upper - joint.lower) * between(0.05, 0.95));
    }
    KDL::Frame& goal = goals.emplace_back(tool(q.data()));
    if (i == 2 && is_far) goal.p.x(50);
    double rpy[3];
    goal.M.GetRPY(rpy[0], rpy[1], rpy[2]);
    for (const double length : goal.p.data) positions_mm.push_back(1e3 * length);
    for (const double angle : rpy) rpy_deg.push_back(angle * 180 / M_PI);
  }
  const double period_s = one_of({0.0005, 0.001, 0.002, 0.005, 0.02});
  const bool is_led = below(3) == 0;  // by somebody who pauses it
  const auto* path = one_of(Words{"joint_move", "orientations"});
  const auto* trajectory = one_of(Words{"quintic", "quintic_spline", "cubic_spline", "sampled"});
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
void expect_limits_and_goals(const AnyArm& arm, std::string reference) {
  constexpr double kOfALimit = 1.001, kBeyond = 1e-6;  // what motion allows a trajectory
  const std::size_t dof = arm.joints.size();
  Numbers missed(arm.is_far ? 2 : 3, 1e9);
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
      const KDL::Twist miss = KDL::diff(arm.tool(q), arm.goals[i]);
      missed[i] = std::min(missed[i], miss.vel.Norm() + miss.rot.Norm());
    }
  }
  for (const double miss : missed) EXPECT_LT(miss, 3e-6);
}

TEST(AnyArmOnATour, KeepsItsLimitsAndReachesItsGoals) {
  const int first = environment_number("ARMATURE_FIRST_ARM", 1),
            count = environment_number("ARMATURE_ARMS", 5);
  for (int seed = first; seed < first + count; ++seed) {
    const AnyArm arm{seed};
    const TemporaryFolder folder;
    std::ofstream{folder / "arm.urdf"} << arm.urdf;
    std::ofstream{folder / "arm.yaml"}
        << fmt::format("armature_robot: 1\nname: any\nurdf: arm.urdf\ntip: {}\nhome: [{:.17g}]\n",
                       arm.tip, fmt::join(arm.home, ", "));
    DeploymentStart start{.files = {source_file("tests/by_lot/any_arm.yaml")},
                          .settings = arm.settings};
    start.options.environment = {{"ARMATURE_PLUGIN_PATH", TEST_PLUGINS},
                                 {"ARM_FOLDER", folder.path()}};
    const DeploymentRun run = run_deployment(start);
    SCOPED_TRACE(fmt::format("ARMATURE_FIRST_ARM={} ARMATURE_ARMS=1\n{}\n{}\n{}", seed, arm.urdf,
                             fmt::join(arm.settings, "\n"), run.text()));
    EXPECT_EQ(run.status(), arm.is_far ? "refused" : "ok");
    EXPECT_EQ(run.word("reason").starts_with("waypoint 3: ik: the goal: out_of_reach"), arm.is_far);
    expect_limits_and_goals(arm, content_of(folder / "reference.csv"));
  }
}

}  // namespace
}  // namespace armature::test
