// SPDX-License-Identifier: Apache-2.0
// The laws see every fault: a solver that keeps them all, and one that breaks each.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "armature/kinds/ik/batch.hpp"
#include "armature/kinds/ik/contract.hpp"
#include "armature/robot/kinematics/kinematics.hpp"

namespace armature {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;

/// Slides along z, y and x, then a pan and a tilt that point with the tool's x.
RobotModel pan_tilt_gantry() {
  const auto joint = [](const char* name, Joint::Type type, double theta, double alpha,
                        double limit) {
    Joint made;
    made.name = name;
    made.type = type;
    made.theta = theta;
    made.alpha = alpha;
    made.lower = -limit;
    made.upper = limit;
    return made;
  };
  using Type = Joint::Type;
  return {
      {"pan_tilt_gantry",
       RobotModel::Convention::standard,
       {joint("z", Type::prismatic, 0, -kQuarter, 1),
        joint("y", Type::prismatic, kQuarter, kQuarter, 1), joint("x", Type::prismatic, 0, 0, 1),
        joint("pan", Type::revolute, 0, kQuarter, 3), joint("tilt", Type::revolute, 0, 0, 2)},
       {{"tool", 4, Eigen::Isometry3d::Identity()}},
       FrameId{0},
       Eigen::Vector3d::UnitX(),
       {}}};
}

enum class Fault {
  none,
  wrong_joints,
  wrong_residual,
  nan_when_singular,
  a_branch_missing,
  no_branch_when_singular,
  says_within_limits,
  says_singular,
  never_singular,
  unwrapped,
  same_label,
  out_of_limits_refused,
  shortfall_of_zero,
  branch_out_of_reach,
  labels_jump,
  remembers,
  bad_input_solved,
  allocates,
  batch_elsewhere,
  batch_loses_a_branch,
  batch_flags_wrong,
  batch_misses_goal,
  batch_solves_bad_input,
  throws
};

/// The gantry's closed form: two branches, the pan there or turned by half a turn.
class Gantry : public IkSolver {
 public:
  Gantry(const RobotModel& model, Fault fault) : model_{model}, fault_{fault} {
    const Eigen::Isometry3d zero = forward_kinematics(model, JointVector::Zero(5));
    const JointVector tilted = JointVector::Unit(5, 4) * kQuarter;
    const JointVector panned = JointVector::Unit(5, 3) * kQuarter;
    // Where the tool points at pan 0, pan 90 degrees and tilt 90 degrees.
    base_R_pan_.col(0) = zero.linear().col(0);
    base_R_pan_.col(1) = forward_kinematics(model, panned).linear().col(0);
    base_R_pan_.col(2) = forward_kinematics(model, tilted).linear().col(0);
  }

  IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                 IkState&) const override {
    out.clear();
    if (const char* why = invalid_input(model_, goal, seed)) {
      if (fault_ == Fault::bad_input_solved) return {};
      return {IkStatus::Code::invalid_input, 0, why};
    }
    if (!std::holds_alternative<Direction>(goal.pose.orientation)) {
      return {IkStatus::Code::invalid_input, 0, "five joints take a direction"};
    }
    if (fault_ == Fault::throws) throw std::runtime_error("no memory left");
    if (fault_ == Fault::allocates) {
      kept_ = new double{seed[0]};  // kept for a moment, or the compiler leaves it out
      delete kept_.load();
    }
    const Eigen::Vector3d beyond = goal.pose.position.cwiseAbs() - Eigen::Vector3d::Ones();
    if (beyond.maxCoeff() > 1e-9 && fault_ != Fault::branch_out_of_reach) {
      const double far = beyond.cwiseMax(0).norm();
      return {IkStatus::Code::out_of_reach, fault_ == Fault::shortfall_of_zero ? 0 : far, "slides"};
    }
    return solve_turns(goal, seed, out);
  }

  void solve_batch(const IkBatch& batch, const JointVector& seed,
                   IkBatchAnswers& out) const override {
    IkSolver::solve_batch(batch, seed, out);
    const auto first = static_cast<std::size_t>(
        std::ranges::find_if(out.found, [](unsigned bits) { return bits != 0; }) -
        out.found.begin());
    for (std::size_t i = 0; fault_ == Fault::batch_elsewhere && i < batch.count; ++i) {
      out.joint(1, 3)[i] += 1e-3;
    }
    if (first == batch.count) return;
    if (fault_ == Fault::batch_loses_a_branch) out.found[first] = 1;
    if (fault_ == Fault::batch_flags_wrong) out.singular[first] ^= 1;
    if (fault_ == Fault::batch_misses_goal) out.angle_rad[first] = 1e-6;
    if (fault_ != Fault::batch_solves_bad_input) return;
    std::ranges::replace(out.code, IkStatus::Code::invalid_input, IkStatus::Code::ok);
  }

 private:
  IkStatus solve_turns(const IkGoal& goal, const JointVector& seed, IkBranches& out) const {
    const auto& direction = std::get<Direction>(goal.pose.orientation).unit;
    const Eigen::Vector3d w = base_R_pan_.transpose() * direction;
    const double flat = std::hypot(w.x(), w.y());
    const bool upright = flat < 1e-12;
    if (upright && fault_ == Fault::no_branch_when_singular) {
      return {IkStatus::Code::no_convergence, 1, ""};
    }
    double pan = upright ? seed[3] : std::atan2(w.y(), w.x());
    if (upright && fault_ == Fault::nan_when_singular) pan = std::nan("");
    const double tilt = std::atan2(w.z(), flat);
    add(goal, "front", pan, tilt, flat, out);
    if (fault_ != Fault::a_branch_missing) {
      add(goal, fault_ == Fault::same_label ? "front" : "back", pan + 2 * kQuarter,
          2 * kQuarter - tilt, flat, out);
    }
    for (const IkBranch& branch : out) {
      if (branch.within_limits) return {};
    }
    return {IkStatus::Code::joint_limit, 0, "both branches"};
  }

  void add(const IkGoal& goal, std::string_view label, double pan, double tilt, double flat,
           IkBranches& out) const {
    const Eigen::Vector3d& p = goal.pose.position;
    IkBranch& branch = out.add();
    branch.label = label;
    branch.q.resize(5);
    branch.q << p.z(), p.y(), p.x(), wrap_angle(pan), wrap_angle(tilt);
    if (fault_ == Fault::wrong_joints) branch.q[4] += 1e-8;
    if (fault_ == Fault::labels_jump && std::fmod(std::abs(1e6 * p.x()), 2) > 1) {
      branch.label = label == "front" ? "back" : "front";
    }
    if (fault_ == Fault::remembers) branch.q[0] += 1e-15 * calls_++;
    branch.redundancy = 0;
    branch.residual =
        residual(forward_kinematics(model_, branch.q), Eigen::Vector3d::UnitX(), goal.pose);
    if (fault_ == Fault::wrong_residual) branch.residual.position_m += 1e-10;
    branch.singular = flat < 1e-6;
    if (fault_ == Fault::says_singular) branch.singular = true;
    if (fault_ == Fault::never_singular) branch.singular = false;
    JointVector turned = branch.q;
    branch.within_limits = unwind(model_, branch.q, turned) || fault_ == Fault::says_within_limits;
    if (fault_ == Fault::unwrapped) branch.q[3] += 4 * kQuarter;
    if (fault_ == Fault::out_of_limits_refused && label == "front") --out.count;
  }

  const RobotModel& model_;
  Fault fault_;
  Eigen::Matrix3d base_R_pan_;
  mutable std::atomic<int> calls_ = 0;
  mutable std::atomic<double*> kept_ = nullptr;
};

IkSubject subject(Fault fault) {
  const auto model = std::make_shared<const RobotModel>(pan_tilt_gantry());
  return {.model = model,
          .solver = std::make_shared<const Gantry>(*model, fault),
          .closed_form = true,
          .poses = 500,
          .edge_poses = 100};
}

INSTANTIATE_TEST_SUITE_P(Gantry, IkLaws,
                         testing::Values(IkLawCase{"gantry", [] { return subject(Fault::none); }}),
                         testing::PrintToStringParamName());

struct Case {
  const char* name;
  Fault fault;
  std::string_view law;
  const char* says;  // part of what the first violation says
};
void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

class FaultySolver : public testing::TestWithParam<Case> {};

LawReport report_of(std::string_view name, const IkSubject& of) {
  for (const IkLaw& law : ik_laws()) {
    if (law.name == name) return check_law(law, of, counting_tools());
  }
  throw std::logic_error("no law " + std::string{name});
}

TEST_P(FaultySolver, BreaksTheLawThatIsAboutIt) {
  const auto& [name, fault, law, says] = GetParam();
  const LawReport report = report_of(law, subject(fault));
  if (!report.skipped.empty()) GTEST_SKIP() << report.skipped;
  ASSERT_FALSE(report.kept());
  EXPECT_NE(report.violations.front().what.find(says), std::string::npos)
      << report.violations.front().what;
}

INSTANTIATE_TEST_SUITE_P(
    Gantry, FaultySolver,
    testing::Values(
        Case{"wrong_joints", Fault::wrong_joints, "ForwardKinematicsOfEverySolutionIsTheGoal",
             "misses the goal by"},
        Case{"wrong_residual", Fault::wrong_residual, "ForwardKinematicsOfEverySolutionIsTheGoal",
             "tells a residual of 1e-10"},
        Case{"nan_when_singular", Fault::nan_when_singular, "SingularPosturesAreAnswered",
             "joints that are no numbers"},
        Case{"a_branch_missing", Fault::a_branch_missing,
             "TheJointsThatMadeAGoalAreAmongItsSolutions", "made this goal, the nearest of 1"},
        Case{"no_branch_when_singular", Fault::no_branch_when_singular,
             "SingularPosturesAreAnswered", "singular to 0: no_convergence"},
        Case{"a_branch_missing_at_limits", Fault::a_branch_missing,
             "PosturesAtTheJointLimitsAreAnswered", "at joint limits"},
        Case{"says_within_limits", Fault::says_within_limits, "FlagsAndLabelsTellTheTruth",
             "says it is within the limits and is not"},
        Case{"says_singular", Fault::says_singular, "FlagsAndLabelsTellTheTruth",
             "is flagged singular"},
        Case{"never_singular", Fault::never_singular, "SingularPosturesAreAnswered",
             "is singular (manipulability"},
        Case{"unwrapped", Fault::unwrapped, "FlagsAndLabelsTellTheTruth", "not wrapped"},
        Case{"same_label", Fault::same_label, "FlagsAndLabelsTellTheTruth",
             "two branches are labelled front"},
        Case{"out_of_limits_refused", Fault::out_of_limits_refused, "AGoalWithinLimitsIsReached",
             "joints within limits reach"},
        Case{"shortfall_of_zero", Fault::shortfall_of_zero, "AGoalOutOfReachSaysHowFar",
             "is said to miss by 0"},
        Case{"labels_jump", Fault::labels_jump,
             "ASmallChangeOfTheGoalIsASmallChangeOfTheJointsAwayFromSingularPoses",
             "the goal has moved a little"},
        Case{"remembers", Fault::remembers, "EqualInputGivesEqualBitsFromAnyThread",
             "asked again in the same thread"},
        Case{"bad_input_solved", Fault::bad_input_solved, "BadInputIsAnsweredAndNotSolved",
             "a position that is no number is answered with 'ok'"},
        Case{"allocates", Fault::allocates, "SolvingDoesNotAllocate", "1 allocations in one solve"},
        Case{"batch_elsewhere", Fault::batch_elsewhere, "ABatchIsAnsweredAsItsGoalsAreOneByOne",
             "branch back stands 0.001 rad or m elsewhere"},
        Case{"batch_loses_a_branch", Fault::batch_loses_a_branch,
             "ABatchIsAnsweredAsItsGoalsAreOneByOne", "1 branches instead of 2"},
        Case{"batch_flags_wrong", Fault::batch_flags_wrong, "ABatchIsAnsweredAsItsGoalsAreOneByOne",
             "branch front has other flags"},
        Case{"batch_misses_goal", Fault::batch_misses_goal, "ABatchIsAnsweredAsItsGoalsAreOneByOne",
             "a residual of 0 m and 1e-06 rad"},
        Case{"batch_solves_bad_input", Fault::batch_solves_bad_input,
             "ABatchIsAnsweredAsItsGoalsAreOneByOne", "'ok' instead of 'invalid_input'"},
        Case{"throws", Fault::throws, "AGoalWithinLimitsIsReached",
             "the solver throws: no memory left"}),
    testing::PrintToStringParamName());

TEST(IkLaw, AViolationNamesTheQuestionAsALineForTheCalculator) {
  const LawReport report =
      report_of("ForwardKinematicsOfEverySolutionIsTheGoal", subject(Fault::wrong_residual));
  const std::string& line = report.violations.at(0).question;
  EXPECT_EQ(line.rfind("{\"position_m\":[", 0), 0U) << line;
  EXPECT_NE(line.find("\"direction\":["), std::string::npos) << line;
  EXPECT_NE(line.find("\"seed\":["), std::string::npos) << line;
}

TEST(IkLaw, WithoutPromisesOnlyASeedThatIsASolutionHasToBeReached) {
  IkSubject one = subject(Fault::a_branch_missing);
  one.closed_form = one.any_seed = one.any_seed_at_edges = false;
  const LawReport report = report_of("AGoalWithinLimitsIsReached", one);
  EXPECT_NE(report.note.find("`any_seed` is not provided"), std::string::npos) << report.note;
}

}  // namespace
}  // namespace armature
