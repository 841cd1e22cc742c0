// SPDX-License-Identifier: Apache-2.0
// SR-1, the choice of a branch over the whole path: the one whose greatest joint speed is least.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "armature/config/document.hpp"
#include "armature/kinds/select/select.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "sr1_arms.hpp"

namespace armature::paper {
namespace {

constexpr int kPoints = 81;
constexpr double kDuration_s = 8;
constexpr double kStandOff = 0.05;  // [m] before the entry

/// The planned path: from home to the stand-off point and on to the target, uniform in length.
std::vector<Eigen::Isometry3d> planned_path() {
  const Figures plan = sr1()["minmax"];
  Eigen::Matrix3d R;
  for (std::size_t i = 0; i < 3; ++i) {
    R.row(static_cast<Eigen::Index>(i)) = plan["R"][i].numbers();
  }
  const Eigen::Vector3d home = plan["home"].numbers(), target = plan["target"].numbers();
  const Eigen::Vector3d entry = plan["entry"].numbers();
  const Eigen::Vector3d stand_off = entry - kStandOff * (target - entry).normalized();
  const double first = (stand_off - home).norm(), second = (target - stand_off).norm();
  std::vector<Eigen::Isometry3d> path;
  for (int k = 0; k < kPoints; ++k) {
    const double s = (first + second) * k / (kPoints - 1);
    const Eigen::Vector3d point = s <= first
                                      ? Eigen::Vector3d{home + (stand_off - home) * (s / first)}
                                      : stand_off + (target - stand_off) * ((s - first) / second);
    Eigen::Isometry3d& pose = path.emplace_back(Eigen::Isometry3d::Identity());
    pose.linear() = R;
    pose.translation() = point;
  }
  return path;
}

/// The arm of the plan, its solutions at every point of the path, and what a selector takes.
class Choice {
 public:
  explicit Choice(SolvedArm arm) : arm_{std::move(arm)}, solutions_(kPoints) {
    const auto path = planned_path();
    for (std::size_t k = 0; k < path.size(); ++k) {
      arm_.solve(goal_of(path[k]), JointVector::Zero(6), solutions_[k]);
      EXPECT_EQ(solutions_[k].count, 8);
    }
    // Before the path the arm moves in joint space; how far does not matter.
    const config::Node free = config::parse_text("first_move: free", "test");
    config::Problems problems;
    static PluginRegistry plugins{{ARMATURE_PLUGIN_BUILD_DIR}};
    const Params params =
        Params::read(plugins.find("select/minmax")->params, &free, "select/minmax", problems);
    const auto selector = plugins.make<BranchSelector>("select/minmax", *arm_.model, params);
    chosen_ = (*selector)->choose(JointVector::Zero(6), solutions_).value();
  }

  /// The label of the branch that was taken at every point; empty when it changes.
  std::string label() const {
    std::string all;
    for (std::size_t k = 0; k < chosen_.size(); ++k) {
      for (const IkBranch& branch : solutions_[k]) {
        if (wrapped_difference(branch.q, chosen_[k]) > 1e-9) continue;
        if (k > 0 && all != branch.label) return "";
        all = branch.label;
      }
    }
    return all;
  }
  /// The greatest share of a joint's highest speed between two points.
  double greatest_step() const {
    double greatest = 0;
    for (std::size_t k = 1; k < chosen_.size(); ++k) {
      greatest = std::max(greatest, share(chosen_[k] - chosen_[k - 1], 1));
    }
    return greatest;
  }
  /// The same by central differences (one-sided at the ends), as the figures' index has it.
  double index() const {
    double greatest = 0;
    for (std::size_t k = 0; k < chosen_.size(); ++k) {
      const std::size_t from = k == 0 ? 0 : k - 1, to = std::min(k + 1, chosen_.size() - 1);
      greatest =
          std::max(greatest, share(chosen_[to] - chosen_[from], static_cast<double>(to - from)));
    }
    return greatest;
  }

 private:
  double share(const JointVector& way, double steps) const {
    const double dt = kDuration_s / (kPoints - 1);
    return way.cwiseAbs().cwiseQuotient(arm_.model->max_velocity()).maxCoeff() / (steps * dt);
  }

  SolvedArm arm_;
  std::vector<IkBranches> solutions_;
  std::vector<JointVector> chosen_;
};

/// The arm as if every joint could turn as far as it likes.
SolvedArm without_limits() {
  const SolvedArm arm = sr1_with_tool(sr1()["minmax"]["tool_d6"].number());
  auto joints = arm.model->joints();
  for (Joint& joint : joints) joint.lower = -1000, joint.upper = 1000;
  return solved_arm({"sr1",
                     arm.model->convention(),
                     std::move(joints),
                     arm.model->frames(),
                     arm.model->tool(),
                     {},
                     {}});
}

/// The figures' branch with these signs.
Figures branch(const Figures& signs) {
  const Figures all = sr1()["minmax"]["branches"];
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (label_of(all[i]["s1_s3_s5"]) == label_of(signs)) return all[i];
  }
  throw std::out_of_range("no such branch");
}

TEST(Sr1BranchChoice, WithinLimitsTheOnlyBranchIsTakenAndMovesAsTheFiguresSay) {
  const Figures plan = sr1()["minmax"];
  const Choice choice{sr1_with_tool(plan["tool_d6"].number())};
  EXPECT_EQ(choice.label(), label_of(plan["chosen_with_limits"]));
  EXPECT_NEAR(choice.greatest_step(), plan["dp_bottleneck_with_limits"].number(), 1e-7);
  EXPECT_NEAR(choice.index(), branch(plan["chosen_with_limits"])["index"].number(), 1e-7);
}

TEST(Sr1BranchChoice, WithoutLimitsTheOtherElbowMovesLessThanHalfAsFast) {
  const Figures plan = sr1()["minmax"];
  const Choice choice{without_limits()};
  // The two wrists move alike: the tie goes to the one that is nearer to the start.
  const std::string arm = label_of(plan["chosen_without_limits"]).substr(0, 16);
  EXPECT_EQ(choice.label().substr(0, 16), arm);
  EXPECT_NEAR(choice.index(), branch(plan["chosen_without_limits"])["index"].number(), 1e-7);
}

}  // namespace
}  // namespace armature::paper
