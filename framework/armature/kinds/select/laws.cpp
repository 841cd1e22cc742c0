// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/select/laws.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <string_view>
#include <vector>

namespace armature {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kStep = 0.3;    // [rad] or [m] between two postures of a random path
constexpr double kWidest = 100;  // [rad] or [m] a joint without limits is asked to go so far
constexpr std::uint64_t kSeed = 23;

/// Postures and waypoints of a robot by lot.
class Postures {
 public:
  explicit Postures(const RobotModel& model) : model_{model} {}

  JointVector any() {
    JointVector q(model_.dof());
    for (int i = 0; i < q.size(); ++i) {
      q[i] = between(std::max(model_.lower()[i], -kWidest), std::min(model_.upper()[i], kWidest));
    }
    return q;
  }
  JointVector neighbour(const JointVector& q) {
    JointVector next = q;
    for (int i = 0; i < q.size(); ++i) {
      next[i] = std::clamp(q[i] + between(-kStep, kStep), model_.lower()[i], model_.upper()[i]);
    }
    return next;
  }
  /// A posture beyond the limits of one joint at every turn; nothing when every joint turns all
  /// round, or has no limits.
  std::optional<IkBranch> branch_outside() {
    for (int i = 0; i < model_.dof(); ++i) {
      if (!std::isfinite(model_.upper()[i])) continue;
      JointVector q = any();
      q[i] = model_.upper()[i] + 0.01;
      IkBranch branch = branch_at(q);
      if (!branch.within_limits) return branch;
    }
    return std::nullopt;
  }
  /// The posture among others, some of them outside the limits, in any order.
  IkBranches waypoint_with(const JointVector& q, int others) {
    std::vector<IkBranch> all{branch_at(q)};
    for (int i = 0; i < others; ++i) {
      const auto outside = i % 2 == 1 ? branch_outside() : std::nullopt;
      all.push_back(outside ? *outside : branch_at(any()));
    }
    std::shuffle(all.begin(), all.end(), random_);
    IkBranches branches;
    for (const IkBranch& branch : all) branches.add() = branch;
    return branches;
  }

 private:
  double between(double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random_);
  }
  /// As a solver tells it: freely turning joints in [-pi, pi).
  IkBranch branch_at(JointVector q) const {
    for (int i = 0; i < q.size(); ++i) {
      if (turns_freely(model_, i)) q[i] = wrap_angle(q[i]);
    }
    JointVector turned = q;
    const bool inside = unwind(model_, q, turned);
    return {.label = "some", .q = q, .within_limits = inside};
  }

  const RobotModel& model_;
  std::mt19937_64 random_{kSeed};
};

std::string words(const JointVector& q) {
  return fmt::format("({})", fmt::join(q.data(), q.data() + q.size(), ", "));
}

bool is_branch(const RobotModel& model, const JointVector& q, const IkBranches& branches) {
  for (const IkBranch& branch : branches) {
    bool same = true;
    for (int i = 0; i < q.size(); ++i) {
      const double d = q[i] - branch.q[i];
      const double left = turns_freely(model, i) ? std::remainder(d, kTurn) : d;
      same = same && std::abs(left) <= 1e-9;
    }
    if (same) return true;
  }
  return false;
}

/// More than half a turn apart only where the nearer turn is outside the limits.
void check_near(const RobotModel& model, const JointVector& before, const JointVector& q,
                LawCheck& check) {
  for (int i = 0; i < q.size(); ++i) {
    if (!turns_freely(model, i)) continue;
    const double turns = std::round((q[i] - before[i]) / kTurn);
    if (std::abs(q[i] - before[i]) <= kTurn / 2 + 1e-9) continue;
    const double nearer = q[i] - turns * kTurn;
    if (nearer < model.lower()[i] - 1e-9 || nearer > model.upper()[i] + 1e-9) continue;
    check.violated(
        fmt::format("independent joint {} goes from {} to {} rad, {} is nearer and "
                    "within the limits",
                    i + 1, before[i], q[i], nearer));
  }
}

/// One position for each waypoint: within limits, a branch of it and near the one before.
void check_chosen(const RobotModel& model, const std::vector<JointVector>& chosen,
                  const JointVector& start, const std::vector<IkBranches>& waypoints,
                  LawCheck& check) {
  if (!check.equal(chosen.size(), waypoints.size(), "joint positions, one for each waypoint")) {
    return;
  }
  JointVector before = start;
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const JointVector& q = chosen[k];
    if (!check.equal(q.size(), model.dof(), "joints of a position that was chosen")) return;
    const auto violated = [&](std::string_view how) {
      check.violated(fmt::format("waypoint {} of {}: the joint position {} {}", k + 1,
                                 chosen.size(), words(q), how));
    };
    if (!model.within_limits(q)) violated("is outside the limits");
    if (!is_branch(model, q, waypoints[k])) violated("is none of the waypoint's branches");
    check_near(model, before, q, check);
    before = q;
  }
}

void chooses_near(const SelectSubject& subject, LawCheck& check) {
  Postures postures{*subject.model};
  for (int round = 0; round < 200; ++round) {
    const JointVector start = postures.any();
    std::vector<IkBranches> waypoints;
    JointVector q = start;
    for (int k = 0; k < 1 + round % 20; ++k) {
      q = postures.neighbour(q);
      waypoints.push_back(postures.waypoint_with(q, round % 6));
    }
    check.asks(fmt::format("seed {}, round {}: from {} through {} waypoints of {} branches", kSeed,
                           round, words(start), waypoints.size(), 1 + round % 6));
    const auto chosen = subject.selector->choose(start, waypoints);
    if (!check.answered(chosen, "a path that can be gone")) return;
    check_chosen(*subject.model, *chosen, start, waypoints, check);
  }
}

void follows_turns(const SelectSubject& subject, LawCheck& check) {
  Postures postures{*subject.model};
  for (int round = 0; round < 100; ++round) {
    std::vector<JointVector> path{postures.any()};
    std::vector<IkBranches> waypoints;
    for (int k = 0; k < 40; ++k) {
      path.push_back(postures.neighbour(path.back()));
      waypoints.push_back(postures.waypoint_with(path.back(), 0));
    }
    check.asks(
        fmt::format("seed {}, round {}: from {} through 40 waypoints of one branch, {} rad "
                    "or m at the most from one to the next",
                    kSeed, round, words(path.front()), kStep));
    const auto chosen = subject.selector->choose(path.front(), waypoints);
    if (!check.answered(chosen, "a path that can be gone")) return;
    if (!check.equal(chosen->size(), waypoints.size(), "joint positions, one for each waypoint")) {
      return;
    }
    for (std::size_t k = 0; k < chosen->size(); ++k) {
      const JointVector& q = (*chosen)[k];
      if (!check.equal(q.size(), path[k + 1].size(), "joints of a position that was chosen"))
        return;
      check.at_most((q - path[k + 1]).cwiseAbs().maxCoeff(), 1e-9,
                    "from the only branch, at the turn next to the position before, to the one "
                    "that was chosen [rad or m]");
    }
  }
}

void full_waypoints(const SelectSubject& subject, LawCheck& check) {
  Postures postures{*subject.model};
  const JointVector start = postures.any();
  const std::vector waypoints(
      2, postures.waypoint_with(postures.neighbour(start), IkBranches::kCapacity - 1));
  check.asks(fmt::format("seed {}: from {} through two waypoints of {} branches", kSeed,
                         words(start), IkBranches::kCapacity));
  const auto chosen = subject.selector->choose(start, waypoints);
  if (!check.answered(chosen, "a path that can be gone")) return;
  check_chosen(*subject.model, *chosen, start, waypoints, check);
}

void names_waypoint(const SelectSubject& subject, LawCheck& check) {
  Postures postures{*subject.model};
  const JointVector start = postures.any();
  const IkBranches good = postures.waypoint_with(start, 0);
  std::vector<IkBranches> bad{IkBranches{}};
  if (const auto outside = postures.branch_outside()) {
    bad.emplace_back().add() = *outside;
    bad.back().add() = *outside;
  }
  for (const IkBranches& none : bad) {
    for (std::size_t place = 0; place < 4; ++place) {
      std::vector<IkBranches> waypoints(4, good);
      waypoints[place] = none;
      const std::string named = fmt::format("waypoint {} of 4: ", place + 1);
      check.asks(fmt::format("{}{} branches, none of them within the limits", named, none.count));
      const auto refused = subject.selector->choose(start, waypoints);
      if (!check.refused(refused, "a waypoint without a branch within limits")) return;
      check.equal(refused.error().text.substr(0, named.size()), named,
                  "the words that the reason begins with");
    }
  }
}

void refuses_bad(const SelectSubject& subject, LawCheck& check) {
  Postures postures{*subject.model};
  const JointVector start = postures.any();
  const IkBranches good = postures.waypoint_with(start, 2);
  const int dof = subject.model->dof();
  const auto refused_with = [&](const std::string& reason, const JointVector& from,
                                const IkBranches& waypoint) {
    check.asks(fmt::format("from {} through two waypoints", words(from)));
    check.refused_with(subject.selector->choose(from, std::vector{good, waypoint}), reason);
  };
  const std::string dimension =
      fmt::format(" joints, not the {} independent ones of {}", dof, subject.model->name());
  refused_with(fmt::format("the start has {}{}", dof + 1, dimension), JointVector::Zero(dof + 1),
               good);
  refused_with("the start has 0" + dimension, JointVector(0), good);
  JointVector not_finite = start;
  not_finite[dof - 1] = std::numeric_limits<double>::quiet_NaN();
  refused_with("the start is not finite", not_finite, good);
  IkBranches bad = good;
  bad.branch[1].q = JointVector::Zero(dof - 1);
  refused_with(fmt::format("waypoint 2 of 2: a branch has {}{}", dof - 1, dimension), start, bad);
  bad.branch[1].q = not_finite;
  refused_with("waypoint 2 of 2: a branch is not finite", start, bad);
}

void equal_input(const SelectSubject& subject, LawCheck& check) {
  const BranchSelector& selector = *subject.selector;
  Postures postures{*subject.model};
  const JointVector start = postures.any();
  std::vector<IkBranches> waypoints;
  for (int k = 0; k < 10; ++k) waypoints.push_back(postures.waypoint_with(postures.any(), 4));
  check.asks(
      fmt::format("seed {}: from {} through 10 waypoints of 5 branches, asked again after "
                  "another path",
                  kSeed, words(start)));
  const auto first = selector.choose(start, waypoints);
  static_cast<void>(selector.choose(postures.any(), std::vector{waypoints.back()}));
  const auto second = selector.choose(start, waypoints);
  if (!check.answered(first, "a path") || !check.answered(second, "the same path")) return;
  check.that(*first == *second, "equal input gives equal joint positions, to the bit");
}

void no_waypoints(const SelectSubject& subject, LawCheck& check) {
  const JointVector start = Postures{*subject.model}.any();
  check.asks(fmt::format("from {} through no waypoint", words(start)));
  const auto chosen = subject.selector->choose(start, {});
  if (!check.answered(chosen, "a path without waypoints")) return;
  check.that(chosen->empty(), "a path without waypoints is empty");
}

}  // namespace

#define ARMATURE_LAW_ENTRY(Name, function, says) Law<SelectSubject>{#Name, says, &function},
std::span<const Law<SelectSubject>> select_laws() {
  static constexpr std::array kLaws{ARMATURE_SELECT_LAWS(ARMATURE_LAW_ENTRY)};
  return kLaws;
}

}  // namespace armature
