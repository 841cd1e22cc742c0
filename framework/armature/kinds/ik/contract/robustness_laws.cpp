// SPDX-License-Identifier: Apache-2.0
// The laws of how a solver behaves, whatever it finds.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <thread>
#include <vector>

#include "armature/kinds/ik/contract/laws.hpp"
#include "armature/kinds/ik/contract/postures.hpp"

namespace armature::ik_contract {
namespace {

struct Question {
  IkGoal goal;
  JointVector seed;
};

/// Reachable goals, singular ones and goals out of reach.
std::vector<Question> questions(Probe& probe, int count) {
  std::vector<Question> list;
  for (int i = 0; i < count; ++i) {
    list.push_back({probe.goal_at(probe.random_joints()), probe.random_joints()});
  }
  for (const auto& [q, joint] : singular_postures(probe.model(), count / 4, probe.random())) {
    list.push_back({probe.goal_at(q), probe.random_joints()});
  }
  for (int i = 0; i < count / 4; ++i) {
    list.push_back({probe.goal_at(probe.random_joints()), probe.random_joints()});
    list.back().goal.pose.position *= i % 2 == 0 ? 2 : 100;
  }
  return list;
}

/// An answer, byte for byte.
std::string bytes_of(const IkStatus& status, const IkBranches& found) {
  std::string bytes{to_string(status.code)};
  const auto add = [&](double value) {
    std::array<char, sizeof value> raw;
    std::memcpy(raw.data(), &value, sizeof value);
    bytes.append(raw.data(), raw.size());
  };
  add(status.shortfall);
  bytes += status.detail;
  for (const IkBranch& branch : found) {
    bytes += branch.label;
    for (const double value : branch.q) add(value);
    add(branch.redundancy);
    add(branch.residual.position_m);
    add(branch.residual.angle_rad);
    bytes += branch.within_limits ? 'w' : '-';
    bytes += branch.singular ? 's' : '-';
  }
  return bytes;
}

std::string answer(const IkSolver& solver, const Question& question) {
  IkBranches found;
  IkState state;
  const IkStatus status = solver.solve(question.goal, question.seed, found, state);
  return bytes_of(status, found);
}

}  // namespace

void equal_bits(Probe& probe) {
  const auto asked = questions(probe, 50);
  std::vector<std::string> answers;
  for (const auto& [goal, seed] : asked) {
    probe.solve(goal, seed);
    answers.push_back(bytes_of(probe.status(), probe.found()));
  }
  constexpr std::size_t kThreads = 4;
  std::array<std::vector<std::string>, kThreads> others;
  {
    std::vector<std::jthread> threads;
    for (auto& list : others) {
      list.resize(asked.size());
      const bool backwards = (&list - others.data()) % 2 == 1;
      threads.emplace_back([&, backwards] {
        for (std::size_t i = 0; i < asked.size(); ++i) {
          const std::size_t k = backwards ? asked.size() - 1 - i : i;
          list[k] = answer(probe.solver(), asked[k]);
        }
      });
    }
  }
  for (std::size_t i = 0; i < asked.size(); ++i) {
    probe.solve(asked[i].goal, asked[i].seed);
    if (bytes_of(probe.status(), probe.found()) != answers[i]) {
      probe.violated("asked again in the same thread, the answer is another one");
    }
    for (const auto& list : others) {
      if (list[i] != answers[i])
        probe.violated("asked in another thread, the answer is another one");
    }
  }
}

namespace {

void expect_refusal(Probe& probe, const char* what, const IkGoal& goal, const JointVector& seed) {
  const IkStatus& status = probe.solve(goal, seed);
  if (status.code != IkStatus::Code::invalid_input || status.detail.empty()) {
    probe.violated_without_line(fmt::format("{} is answered with '{}'", what, describe(status)));
  } else if (probe.found().count != 0) {
    probe.violated_without_line(
        fmt::format("{} is refused, with {} branches", what, probe.found().count));
  }
}

/// Finite, but so large that its square is not.
void expect_no_overflow(Probe& probe, IkGoal goal, const JointVector& seed) {
  for (const double far : {1e160, -1e300}) {
    goal.pose.position.x() = far;
    const IkStatus& status = probe.solve(goal, seed);
    const bool ok = status.code == IkStatus::Code::ok || probe.found().count != 0;
    if (ok || std::isnan(status.shortfall)) {
      probe.violated(
          fmt::format("a goal {:g} m away is answered with '{}'", far, describe(status)));
    }
  }
}

}  // namespace

void bad_input(Probe& probe) {
  const JointVector seed = probe.random_joints();
  const IkGoal good = probe.goal_at(seed);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto refuse = [&](const char* what, auto change) {
    IkGoal goal = good;
    change(goal);
    expect_refusal(probe, what, goal, seed);
  };
  refuse("a position that is no number", [&](auto& g) { g.pose.position.y() = kNan; });
  refuse("an infinite position", [&](auto& g) { g.pose.position.y() = kInfinity; });
  refuse("a zero direction",
         [&](auto& g) { g.pose.orientation = Direction{Eigen::Vector3d::Zero()}; });
  refuse("a direction that is no number",
         [&](auto& g) { g.pose.orientation = Direction{Eigen::Vector3d::Constant(kNan)}; });
  refuse("a rotation that is no number", [&](auto& g) {
    g.pose.orientation = Eigen::Quaterniond{kNan, 0, 0, 1};
  });
  refuse("a zero quaternion", [&](auto& g) {
    g.pose.orientation = Eigen::Quaterniond{0, 0, 0, 0};
  });
  refuse("a quaternion whose square is no number", [&](auto& g) {
    g.pose.orientation = Eigen::Quaterniond{0, 1e200, 0, 0};
  });
  refuse("a tolerance of zero", [&](auto& g) { g.tolerance.position_m = 0; });
  refuse("a tolerance that is no number", [&](auto& g) { g.tolerance.angle_rad = kNan; });
  refuse("an arm angle that is no number", [&](auto& g) { g.redundancy = kNan; });
  const int dof = probe.model().dof();
  expect_refusal(probe, "a seed with too many joints", good, JointVector::Zero(dof + 1));
  expect_refusal(probe, "a seed with too few joints", good, JointVector::Zero(dof - 1));
  expect_refusal(probe, "a seed that is no number", good, JointVector::Constant(dof, kNan));
  expect_refusal(probe, "an infinite seed", good, JointVector::Constant(dof, kInfinity));
  expect_no_overflow(probe, good, seed);
}

void no_allocation(Probe& probe) {
  if (probe.subject().allocates) {
    probe.report().skipped = "its plugin.yaml says `allocates: true`";
    return;
  }
  if (!probe.tools().allocations) {
    probe.report().skipped = "this program does not count allocations";
    return;
  }
  for (const auto& [goal, seed] : questions(probe, 200)) {
    const std::size_t before = probe.tools().allocations();
    probe.solve(goal, seed);
    const std::size_t made = probe.tools().allocations() - before;
    if (made > 0) probe.violated(fmt::format("{} allocations in one solve", made));
    RedundancyIntervals intervals;
    const std::size_t before_intervals = probe.tools().allocations();
    probe.feasible_redundancy(goal, seed, intervals);
    const std::size_t made_then = probe.tools().allocations() - before_intervals;
    if (made_then > 0) {
      probe.violated(fmt::format("{} allocations in one feasible_redundancy", made_then));
    }
  }
}

}  // namespace armature::ik_contract
