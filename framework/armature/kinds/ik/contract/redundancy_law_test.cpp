// SPDX-License-Identifier: Apache-2.0
// The laws of what a pose leaves free: a solver that keeps them, and one that breaks each.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "armature/kinds/ik/contract.hpp"
#include "armature/robot/kinematics/kinematics.hpp"

namespace armature::redundancy_law {
namespace {

constexpr double kPi = std::numbers::pi;

/// Slides along z, y and x, a pan and a tilt that point with the tool's z, and a roll about that,
/// or a second slide along x: what the goal leaves free.
enum class Free { roll, slide };
RobotModel pointing_gantry(Free free) {
  using Type = Joint::Type;
  const auto joint = [](const char* name, Type type, double theta, double alpha, double lower,
                        double upper) {
    Joint made;
    made.name = name;
    made.type = type;
    made.theta = theta;
    made.alpha = alpha;
    made.lower = lower;
    made.upper = upper;
    return made;
  };
  std::vector<Joint> joints{joint("z", Type::prismatic, 0, -kPi / 2, -1, 1),
                            joint("y", Type::prismatic, kPi / 2, kPi / 2, -1, 1),
                            joint("x", Type::prismatic, 0, 0, -1, 1),
                            joint("pan", Type::revolute, 0, kPi / 2, -3, 3),
                            joint("tilt", Type::revolute, kPi / 2, kPi / 2, -2, 2)};
  if (free == Free::roll) {
    joints.push_back(joint("roll", Type::revolute, 0, 0, 1, 4));  // across the cut at pi
  } else {
    joints.insert(joints.begin() + 3, joint("x2", Type::prismatic, 0, 0, -0.5, 0.25));
  }
  return {{"pointing_gantry",
           RobotModel::Convention::standard,
           joints,
           {{"tool", 5, Eigen::Isometry3d::Identity()}},
           FrameId{0},
           Eigen::Vector3d::UnitZ(),
           {}}};
}

enum class Fault {
  none,
  too_wide,
  too_narrow,
  one_missing,
  none_told,
  labels_exchanged,
  not_rising,
  not_cut,
  told_out_of_reach,
  no_redundancy_of_joints,
  another_redundancy,
  allocates,
  a_branch_missing_at_limits
};

/// The closed form: the pan there or turned by half a turn, at the roll or slide that is asked for.
class PointingGantry final : public IkSolver {
 public:
  PointingGantry(const RobotModel& model, Free free, Fault fault)
      : model_{model}, free_{free}, fault_{fault} {
    const auto points = [&](double pan, double tilt) -> Eigen::Vector3d {
      JointVector q = JointVector::Zero(6);
      q[pan_at()] = pan, q[pan_at() + 1] = tilt;
      return forward_kinematics(model, q).linear().col(2);
    };
    base_R_pan_ << points(0, 0), points(kPi / 2, 0), points(0, kPi / 2);
  }

  IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                 IkState&) const override {
    out.clear();
    if (const char* why = invalid_input(model_, goal, seed)) {
      return {IkStatus::Code::invalid_input, 0, why};
    }
    if (!std::holds_alternative<Direction>(goal.pose.orientation)) {
      return {IkStatus::Code::invalid_input, 0, "this arm takes a direction"};
    }
    if (const double beyond = beyond_reach(goal); beyond > 1e-9) {
      return {IkStatus::Code::out_of_reach, beyond, "slides"};
    }
    for (int branch : {0, 1}) add(branch, goal, seed, out);
    const bool any = std::ranges::any_of(out, &IkBranch::within_limits);
    return any ? IkStatus{} : IkStatus{IkStatus::Code::joint_limit, 0, "both branches"};
  }

  std::optional<double> redundancy_of(const JointVector& q) const override {
    if (fault_ == Fault::no_redundancy_of_joints) return std::nullopt;
    if (fault_ == Fault::another_redundancy) return 0.5 * free_of(q);
    return free_of(q);
  }

  bool feasible_redundancy(const IkGoal& goal, const JointVector& seed,
                           RedundancyIntervals& out) const override {
    out.clear();
    if (invalid_input(model_, goal, seed)) return false;
    if (fault_ == Fault::none_told && goal.pose.position.x() > 0.3) return false;
    if (beyond_reach(goal) > 1e-9 && fault_ != Fault::told_out_of_reach) return false;
    if (fault_ == Fault::allocates) kept_ = std::make_unique<double>(seed[0]);
    for (int branch : {0, 1}) {
      IkGoal within = goal;
      within.redundancy = free_ == Free::roll ? 2 : nearest_slide(goal, 0);
      IkBranches found;
      add(branch, within, seed, found);
      if (found.branch[0].within_limits) add_intervals(goal, branch, out);
    }
    return true;
  }
  bool redundancy_is_length() const override { return free_ == Free::slide; }

 private:
  static std::string_view label(int branch) { return branch == 0 ? "front" : "back"; }
  int pan_at() const { return free_ == Free::roll ? 3 : 4; }
  double free_of(const JointVector& q) const { return q[free_ == Free::roll ? 5 : 3]; }

  double beyond_reach(const IkGoal& goal) const {
    Eigen::Vector3d beyond = goal.pose.position.cwiseAbs() - Eigen::Vector3d::Ones();
    if (free_ == Free::slide) beyond.x() -= goal.pose.position.x() > 0 ? 0.25 : 0.5;
    return beyond.cwiseMax(0).norm();
  }
  /// The second slide that is nearest to `wanted` and leaves the first one within its limits.
  static double nearest_slide(const IkGoal& goal, double wanted) {
    const double x = goal.pose.position.x();
    return std::clamp(wanted, std::max(x - 1, -0.5), std::min(x + 1, 0.25));
  }

  void add(int branch, const IkGoal& goal, const JointVector& seed, IkBranches& out) const {
    const Eigen::Vector3d w =
        base_R_pan_.transpose() * std::get<Direction>(goal.pose.orientation).unit.normalized();
    const double flat = std::hypot(w.x(), w.y());
    const double pan = flat < 1e-12 ? seed[pan_at()] : std::atan2(w.y(), w.x());
    const double tilt = std::atan2(w.z(), flat);
    const Eigen::Vector3d& p = goal.pose.position;
    const double free = goal.redundancy ? *goal.redundancy
                        : free_ == Free::slide
                            ? nearest_slide(goal, seed[3])
                            : std::clamp(std::remainder(seed[5] - 2.5, 2 * kPi) + 2.5, 1.0, 4.0);
    JointVector q(6);
    if (free_ == Free::roll) {
      q << p.z(), p.y(), p.x(), branch * kPi + pan, branch == 0 ? tilt : kPi - tilt, free;
    } else {
      q << p.z(), p.y(), p.x() - free, free, branch * kPi + pan, branch == 0 ? tilt : kPi - tilt;
    }
    IkBranch made = branch_at(model_, goal, q, label(branch));
    made.redundancy = free_of(made.q);
    if (fault_ == Fault::a_branch_missing_at_limits && branch == 1 && at_a_limit(made.q)) return;
    out.add() = made;
  }
  bool at_a_limit(const JointVector& q) const {
    return std::min((q - model_.lower()).cwiseAbs().minCoeff(),
                    (q - model_.upper()).cwiseAbs().minCoeff()) < 1e-9;
  }

  void add_intervals(const IkGoal& goal, int branch, RedundancyIntervals& out) const {
    if (fault_ == Fault::labels_exchanged) branch = 1 - branch;
    const double wider = fault_ == Fault::too_wide ? 1e-5 : fault_ == Fault::too_narrow ? -1e-5 : 0;
    const auto add = [&](double lower, double upper) { out.add({label(branch), lower, upper}); };
    if (free_ == Free::slide) {
      return add(nearest_slide(goal, -9) - wider, nearest_slide(goal, 9) + wider);
    }
    if (fault_ == Fault::not_cut) return add(1, 4);
    if (fault_ == Fault::not_rising) add(1, kPi);
    if (fault_ != Fault::one_missing) add(-kPi, 4 - 2 * kPi + wider);
    if (fault_ != Fault::not_rising) add(1 - wider, kPi);
  }

  const RobotModel& model_;
  Free free_;
  Fault fault_;
  Eigen::Matrix3d base_R_pan_;
  mutable std::unique_ptr<double> kept_;
};

IkSubject subject(Free free, Fault fault) {
  const auto model = std::make_shared<const RobotModel>(pointing_gantry(free));
  return {.model = model,
          .solver = std::make_shared<const PointingGantry>(*model, free, fault),
          .closed_form = true,
          .poses = 400,
          .edge_poses = 100};
}

INSTANTIATE_TEST_SUITE_P(
    PointingGantry, IkLaws,
    testing::Values(IkLawCase{"roll", [] { return subject(Free::roll, Fault::none); }},
                    IkLawCase{"slide", [] { return subject(Free::slide, Fault::none); }}),
    testing::PrintToStringParamName());

constexpr std::string_view kLaw = "ABranchKeepsItsLimitsAtTheRedundanciesThatAreToldAndNoOthers";

LawReport report_of(const IkSubject& of, std::string_view name = kLaw) {
  for (const IkLaw& law : ik_laws()) {
    if (law.name == name) return check_law(law, of, counting_tools());
  }
  throw std::logic_error("no such law");
}

struct Case {
  const char* name;
  Fault fault;
  Free free;
  const char* says;  // part of what the first violation says
  std::string_view law = kLaw;

  friend void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }
};

class FaultyRedundancy : public testing::TestWithParam<Case> {};

TEST_P(FaultyRedundancy, BreaksTheLawThatIsAboutIt) {
  const auto& [name, fault, free, says, law] = GetParam();
  const LawReport report = report_of(subject(free, fault), law);
  if (!report.skipped.empty()) GTEST_SKIP() << report.skipped;
  ASSERT_FALSE(report.kept());
  EXPECT_NE(report.violations.front().what.find(says), std::string::npos)
      << report.violations.front().what;
}

INSTANTIATE_TEST_SUITE_P(
    PointingGantry, FaultyRedundancy,
    testing::Values(
        Case{"too_wide", Fault::too_wide, Free::roll, "is told to keep the limits, at -2.283"},
        Case{"too_wide_a_slide", Fault::too_wide, Free::slide, " m is told to keep the limits"},
        Case{"too_narrow", Fault::too_narrow, Free::roll, "and 1e-06 beyond it still keeps"},
        Case{"one_missing", Fault::one_missing, Free::roll, "which no interval of front holds"},
        Case{"none_told", Fault::none_told, Free::roll, "no intervals are told"},
        Case{"labels_exchanged", Fault::labels_exchanged, Free::roll, "it does not"},
        Case{"not_rising", Fault::not_rising, Free::roll, "they must rise and be apart"},
        Case{"not_cut", Fault::not_cut, Free::roll, "front [1, 4] rad is no interval"},
        Case{"told_out_of_reach", Fault::told_out_of_reach, Free::roll,
             "the intervals of a goal 1e6 m out of reach are told"},
        Case{"no_redundancy_of_joints", Fault::no_redundancy_of_joints, Free::roll,
             "intervals are told, and no redundancy of joints"},
        Case{"another_redundancy", Fault::another_redundancy, Free::slide,
             "of the joints that made the goal, the nearest of 2 branches"},
        Case{"allocates", Fault::allocates, Free::roll, "allocations in one feasible_redundancy",
             "SolvingDoesNotAllocate"},
        Case{"a_branch_missing_at_limits", Fault::a_branch_missing_at_limits, Free::roll,
             "at joint limits: the seed is a solution, the nearest of 1",
             "PosturesAtTheJointLimitsAreAnswered"}),
    testing::PrintToStringParamName());

TEST(RedundancyLaw, AViolationNamesTheRedundancyInItsUnit) {
  const auto first_line = [](Free free) {
    return report_of(subject(free, Fault::too_wide)).violations.at(0).question;
  };
  EXPECT_NE(first_line(Free::roll).find("\"redundancy_rad\":-2.283"), std::string::npos);
  EXPECT_NE(first_line(Free::slide).find("\"redundancy_m\":"), std::string::npos);
}

}  // namespace
}  // namespace armature::redundancy_law
