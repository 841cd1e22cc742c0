// SPDX-License-Identifier: Apache-2.0
// The choice is the best there is: held against every choice that can be made.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "armature/robot/kinematics/joint_inertia.hpp"
#include "min_path.hpp"
#include "test_robots.hpp"

namespace armature::select::minmax {
namespace {

constexpr std::array<std::string_view, 4> kLabels{"a", "b", "c", "d"};

/// One choice of a branch for each waypoint, followed from the start.
struct Choice {
  std::vector<std::size_t> branch;
  std::vector<JointVector> path;
  double greatest = 0, sum = 0;
};

/// Start, branches and rules at random.
struct Case {
  RobotModel model;
  Parameters rules;
  JointVector start;
  std::vector<IkBranches> solutions;

  Waypoints waypoints() const {
    Waypoints all;
    for (const IkBranches& found : solutions) {
      all.emplace_back();
      for (const IkBranch& branch : found) all.back().push_back(&branch);
    }
    return all;
  }
};

class Cases {
 public:
  explicit Cases(std::uint64_t seed) : random_{seed} {}

  Case next() {
    Case made{.model = below(2) == 0 ? crane() : winder(), .start = {}};
    if (below(3) == 0) made.rules.first_move = Parameters::FirstMove::free;
    if (below(3) == 0) made.rules.move_size = Parameters::MoveSize::inertia;
    made.rules.one_branch = below(4) == 0;
    if (below(4) == 0) made.rules.jump_limit = between(1, 5);
    made.start = posture(made.model);
    const bool on_a_grid = below(3) == 0;  // equal moves, so that ties must be broken
    for (int k = 1 + below(5); k > 0; --k) {
      IkBranches& found = made.solutions.emplace_back();
      for (int b = 1 + below(4); b > 0; --b) {
        IkBranch& branch = found.add();
        branch.label = kLabels[static_cast<std::size_t>(below(4))];
        branch.q = posture(made.model);
        if (on_a_grid) branch.q = branch.q.array().round();
        for (int i = 0; i < branch.q.size(); ++i) {
          if (turns_freely(made.model, i)) branch.q[i] = wrap_angle(branch.q[i]);
        }
        JointVector turned = branch.q;
        if (!unwind(made.model, branch.q, turned)) branch.q.setZero();
      }
    }
    return made;
  }

 private:
  int below(int end) { return std::uniform_int_distribution{0, end - 1}(random_); }
  double between(double low, double high) {
    return std::uniform_real_distribution{low, high}(random_);
  }
  JointVector posture(const RobotModel& model) {
    JointVector q(model.dof());
    for (int i = 0; i < q.size(); ++i) q[i] = between(model.lower()[i], model.upper()[i]);
    return q;
  }

  std::mt19937_64 random_;
};

/// The length of a move as the arm feels it where it ends.
double length(const RobotModel& model, const JointVector& from, const JointVector& to) {
  const JointVector way = to - from;
  return std::sqrt(way.dot(joint_inertia(model, to) * way));
}

/// Nothing when the rules forbid one of its moves. Says again what a move is, in its own words.
std::optional<Choice> followed(const Case& given, std::vector<std::size_t> branch) {
  Choice choice{.branch = std::move(branch), .path = {}};
  JointVector q = given.start;
  for (std::size_t k = 0; k < choice.branch.size(); ++k) {
    const IkBranch& to = given.solutions[k].branch[choice.branch[k]];
    JointVector next = to.q;
    unwind(given.model, q, next);
    const bool counts = k > 0 || given.rules.first_move == Parameters::FirstMove::counts;
    double size = 0;
    for (int i = 0; i < q.size(); ++i) {
      const double way = std::abs(next[i] - q[i]);
      size = std::max(size, way / given.model.max_velocity()[i]);
      const bool limited = given.rules.jump_limit > 0 && counts && given.model.is_revolute(i);
      if (limited && way > given.rules.jump_limit + 1e-9) return std::nullopt;
    }
    if (given.rules.move_size == Parameters::MoveSize::inertia) size = length(given.model, q, next);
    if (k > 0 && given.rules.one_branch) {
      const IkBranch& from = given.solutions[k - 1].branch[choice.branch[k - 1]];
      if (from.label != to.label) return std::nullopt;
    }
    if (counts) choice.greatest = std::max(choice.greatest, size);
    choice.sum += size;
    choice.path.push_back(next);
    q = next;
  }
  return choice;
}

std::vector<Choice> every_choice(const Case& given) {
  std::vector<Choice> all;
  std::vector<std::size_t> branch(given.solutions.size(), 0);
  for (bool more = true; more;) {
    if (auto choice = followed(given, branch)) all.push_back(std::move(*choice));
    more = false;
    for (std::size_t k = 0; k < branch.size() && !more; ++k) {
      more = ++branch[k] < static_cast<std::size_t>(given.solutions[k].count);
      if (!more) branch[k] = 0;
    }
  }
  return all;
}

/// By the words of the README: greatest, then sum, then the solver's order from the last waypoint.
const Choice* best_of(std::vector<Choice>& all) {
  if (all.empty()) return nullptr;
  const auto keep_least = [&](double Choice::*figure) {
    const double least = (*std::ranges::min_element(all, {}, figure)).*figure;
    std::erase_if(all, [&](const Choice& choice) { return choice.*figure > least + kEqual; });
  };
  keep_least(&Choice::greatest);
  keep_least(&Choice::sum);
  return &*std::ranges::min_element(all, [](const Choice& a, const Choice& b) {
    return std::ranges::lexicographical_compare(a.branch.rbegin(), a.branch.rend(),
                                                b.branch.rbegin(), b.branch.rend());
  });
}

TEST(MinMaxExactness, NoChoiceThatCanBeMadeIsBetter) {
  constexpr std::uint64_t kSeed = 2105;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  Cases cases{kSeed};
  int chosen = 0, ties = 0, refused = 0;
  for (int i = 0; i < 4000; ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    const Case given = cases.next();
    std::vector<Choice> all = every_choice(given);
    const Choice* best = best_of(all);
    const Waypoints waypoints = given.waypoints();
    const Moves moves{given.model, given.rules};
    const auto greatest = LeastPath{moves, waypoints, Measure::greatest}.from(given.start);
    ASSERT_EQ(greatest.complete(waypoints), best != nullptr);
    if (!best) {
      ++refused;
      continue;
    }
    ASSERT_NEAR(greatest.least(), best->greatest, kEqual);
    const LeastPath search{moves, waypoints, Measure::sum, greatest.least() + kEqual};
    const auto sum = search.from(given.start);
    ASSERT_NEAR(sum.least(), best->sum, kEqual);
    ASSERT_EQ(search.first_of(sum), best->path);
    ++chosen;
    if (all.size() > 1) ++ties;
  }
  EXPECT_GT(chosen, 2000);
  EXPECT_GT(ties, 50);
  EXPECT_GT(refused, 300);
}

TEST(MinMaxExactness, TheWaypointThatBarsThePathIsTheFirstThatNoChoiceReaches) {
  constexpr std::uint64_t kSeed = 2106;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  Cases cases{kSeed};
  int barred = 0;
  for (int i = 0; i < 2000; ++i) {
    Case given = cases.next();
    const auto layers = [&] {
      const Waypoints waypoints = given.waypoints();
      return LeastPath{Moves{given.model, given.rules}, waypoints, Measure::greatest}
          .from(given.start)
          .of.size();
    };
    const std::size_t reached = layers();
    if (reached > given.solutions.size()) continue;
    ++barred;
    given.solutions.resize(reached);
    EXPECT_TRUE(every_choice(given).empty()) << "case " << i;
    given.solutions.resize(reached - 1);
    EXPECT_FALSE(every_choice(given).empty()) << "case " << i;
  }
  EXPECT_GT(barred, 150);
}

/// A long path in eight branches that stay apart.
TEST(MinMaxExactness, ALongPathAwayFromLimitsLeavesNoMorePlacesThanBranches) {
  const RobotModel model = winder();
  std::vector<IkBranches> solutions(200);
  for (std::size_t k = 0; k < solutions.size(); ++k) {
    const double way = 0.004 * static_cast<double>(k);
    for (int b = 0; b < 8; ++b) {
      solutions[k].add().q = Eigen::Vector2d{wrap_angle(way + 0.1 * b), wrap_angle(way - 0.7 * b)};
    }
  }
  Waypoints waypoints;
  for (const IkBranches& found : solutions) {
    waypoints.emplace_back();
    for (const IkBranch& branch : found) waypoints.back().push_back(&branch);
  }
  const Moves moves{model, {}};
  for (const Measure measure : {Measure::greatest, Measure::sum}) {
    const auto layers = LeastPath{moves, waypoints, measure}.from(Eigen::Vector2d{0.2, 0.1});
    ASSERT_TRUE(layers.complete(waypoints));
    for (const auto& places : layers.of) EXPECT_LE(places.size(), 8U);
  }
}

}  // namespace
}  // namespace armature::select::minmax
