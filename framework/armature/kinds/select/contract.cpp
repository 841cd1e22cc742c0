// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/select/contract.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace armature {

double SelectLaws::between(double low, double high) {
  return std::uniform_real_distribution<double>{low, high}(random_);
}

JointVector SelectLaws::random_posture() {
  JointVector q(model().dof());
  for (int i = 0; i < q.size(); ++i) q[i] = between(model().lower()[i], model().upper()[i]);
  return q;
}

JointVector SelectLaws::random_neighbour(const JointVector& q) {
  JointVector next = q;
  for (int i = 0; i < q.size(); ++i) {
    next[i] = std::clamp(q[i] + between(-kStep, kStep), model().lower()[i], model().upper()[i]);
  }
  return next;
}

IkBranch SelectLaws::branch_at(JointVector q) const {
  for (int i = 0; i < q.size(); ++i) {
    if (turns_freely(model(), i)) q[i] = wrap_angle(q[i]);
  }
  JointVector turned = q;
  const bool inside = unwind(model(), q, turned);
  return {.label = "some", .q = q, .within_limits = inside};
}

std::optional<IkBranch> SelectLaws::branch_outside() {
  for (int i = 0; i < model().dof(); ++i) {
    JointVector q = random_posture();
    q[i] = model().upper()[i] + 0.01;
    IkBranch branch = branch_at(q);
    if (!branch.within_limits) return branch;
  }
  return std::nullopt;
}

IkBranches SelectLaws::waypoint_with(const JointVector& q, int others) {
  std::vector<IkBranch> all{branch_at(q)};
  for (int i = 0; i < others; ++i) {
    const auto outside = i % 2 == 1 ? branch_outside() : std::nullopt;
    all.push_back(outside ? *outside : branch_at(random_posture()));
  }
  std::shuffle(all.begin(), all.end(), random_);
  IkBranches branches;
  for (const IkBranch& branch : all) branches.add() = branch;
  return branches;
}

bool SelectLaws::is_branch(const JointVector& q, const IkBranches& branches) const {
  for (const IkBranch& branch : branches) {
    bool same = true;
    for (int i = 0; i < q.size(); ++i) {
      const double d = q[i] - branch.q[i];
      const double left = turns_freely(model(), i) ? std::remainder(d, kTurn) : d;
      same = same && std::abs(left) <= 1e-9;
    }
    if (same) return true;
  }
  return false;
}

void SelectLaws::expect_near(const JointVector& before, const JointVector& q) const {
  for (int i = 0; i < q.size(); ++i) {
    if (!turns_freely(model(), i)) continue;
    const double turns = std::round((q[i] - before[i]) / kTurn);
    if (std::abs(q[i] - before[i]) <= kTurn / 2 + 1e-9) continue;
    const double nearer = q[i] - turns * kTurn;
    EXPECT_TRUE(nearer < model().lower()[i] - 1e-9 || nearer > model().upper()[i] + 1e-9)
        << "joint " << i << " went from " << before[i] << " to " << q[i];
  }
}

void SelectLaws::expect_sound(const std::vector<JointVector>& chosen, const JointVector& start,
                              const std::vector<IkBranches>& waypoints) const {
  ASSERT_EQ(chosen.size(), waypoints.size());
  JointVector before = start;
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    ASSERT_EQ(chosen[k].size(), model().dof());
    EXPECT_TRUE(model().within_limits(chosen[k])) << chosen[k].transpose();
    EXPECT_TRUE(is_branch(chosen[k], waypoints[k])) << chosen[k].transpose();
    expect_near(before, chosen[k]);
    before = chosen[k];
  }
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SelectLaws);

TEST_P(SelectLaws, ChoosesABranchOfEveryWaypointWithinLimitsAndNearTheOneBefore) {
  SCOPED_TRACE("seed 23");
  for (int round = 0; round < 200; ++round) {
    const JointVector start = random_posture();
    std::vector<IkBranches> waypoints;
    JointVector q = start;
    for (int k = 0; k < 1 + round % 20; ++k) {
      q = random_neighbour(q);
      waypoints.push_back(waypoint_with(q, round % 6));
    }
    const auto chosen = selector().choose(start, waypoints);
    ASSERT_TRUE(chosen) << chosen.error().text;
    expect_sound(*chosen, start, waypoints);
  }
}

TEST_P(SelectLaws, AnOnlyBranchIsFollowedOverWholeTurns) {
  SCOPED_TRACE("seed 23");
  for (int round = 0; round < 100; ++round) {
    std::vector<JointVector> path{random_posture()};
    std::vector<IkBranches> waypoints;
    for (int k = 0; k < 40; ++k) {
      path.push_back(random_neighbour(path.back()));
      waypoints.push_back(waypoint_with(path.back(), 0));
    }
    const auto chosen = selector().choose(path.front(), waypoints);
    ASSERT_TRUE(chosen) << chosen.error().text;
    for (std::size_t k = 0; k < chosen->size(); ++k) {
      EXPECT_LE(((*chosen)[k] - path[k + 1]).cwiseAbs().maxCoeff(), 1e-9);
    }
  }
}

TEST_P(SelectLaws, AsManyBranchesAsThereMayBeAreConsidered) {
  const JointVector start = random_posture();
  IkBranches full = waypoint_with(random_neighbour(start), IkBranches::kCapacity - 1);
  ASSERT_EQ(full.count, IkBranches::kCapacity);
  const auto chosen = selector().choose(start, std::vector{full, full});
  ASSERT_TRUE(chosen) << chosen.error().text;
  expect_sound(*chosen, start, {full, full});
}

TEST_P(SelectLaws, NamesTheWaypointThatHasNoBranchWithinLimits) {
  const JointVector start = random_posture();
  const IkBranches good = waypoint_with(start, 0);
  std::vector<IkBranches> bad{IkBranches{}};
  if (const auto outside = branch_outside()) {
    bad.emplace_back().add() = *outside;
    bad.back().add() = *outside;
  }
  for (const IkBranches& none : bad) {
    for (std::size_t place = 0; place < 4; ++place) {
      std::vector<IkBranches> waypoints(4, good);
      waypoints[place] = none;
      const auto refused = selector().choose(start, waypoints);
      ASSERT_FALSE(refused);
      const std::string named = "waypoint " + std::to_string(place + 1) + " of 4: ";
      EXPECT_EQ(refused.error().text.substr(0, named.size()), named);
    }
  }
}

TEST_P(SelectLaws, RefusesJointPositionsThatAreNone) {
  const JointVector start = random_posture();
  const IkBranches good = waypoint_with(start, 2);
  const int dof = model().dof();
  const auto refusal = [&](const JointVector& from, const IkBranches& waypoint) {
    const auto refused = selector().choose(from, std::vector{good, waypoint});
    EXPECT_FALSE(refused);
    return refused ? std::string{} : refused.error().text;
  };
  const std::string dimension =
      " joints, not the " + std::to_string(dof) + " independent ones of " + model().name();
  EXPECT_EQ(refusal(JointVector::Zero(dof + 1), good),
            "the start has " + std::to_string(dof + 1) + dimension);
  EXPECT_EQ(refusal(JointVector(0), good), "the start has 0" + dimension);
  JointVector not_finite = start;
  not_finite[dof - 1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal(not_finite, good), "the start is not finite");
  IkBranches bad = good;
  bad.branch[1].q = JointVector::Zero(dof - 1);
  EXPECT_EQ(refusal(start, bad),
            "waypoint 2 of 2: a branch has " + std::to_string(dof - 1) + dimension);
  bad.branch[1].q = not_finite;
  EXPECT_EQ(refusal(start, bad), "waypoint 2 of 2: a branch is not finite");
}

TEST_P(SelectLaws, EqualInputGivesEqualBits) {
  const JointVector start = random_posture();
  std::vector<IkBranches> waypoints;
  for (int k = 0; k < 10; ++k) waypoints.push_back(waypoint_with(random_posture(), 4));
  const auto first = selector().choose(start, waypoints);
  static_cast<void>(selector().choose(random_posture(), std::vector{waypoints.back()}));
  const auto second = selector().choose(start, waypoints);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(*first, *second);
}

TEST_P(SelectLaws, NoWaypointsAreAnEmptyPath) {
  const auto chosen = selector().choose(random_posture(), {});
  ASSERT_TRUE(chosen) << chosen.error().text;
  EXPECT_TRUE(chosen->empty());
}
}  // namespace armature
