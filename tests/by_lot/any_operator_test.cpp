// SPDX-License-Identifier: Apache-2.0
// Operators who say anything at any time, arms that something stops meanwhile, and threads that are
// held up, by where the arm truly is: 1. it rests while the task asks or is paused, 2. after an
// abort it comes to where it shall and moves no more, 3. a tool in a body goes along its line
// only, 4. every word is answered, and the run comes to its end, 5. the same operator gives the
// same run, 6. an arm that is stopped stays so, and a rearm moves nothing. ARMATURE_OPERATORS: so
// many of every system, from number ARMATURE_FIRST_OPERATOR on; `tools/test --full` has others
// every day.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "armature/robot/kinematics/kinematics.hpp"
#include "operated_system.hpp"
#include "tests/environment_number.hpp"

namespace armature::test {
namespace {

using Eigen::Vector3d;

class AnyOperator : public testing::TestWithParam<OperatedSystem> {
 protected:
  using Arm = OperatorChronicle::Arm;
  using Word = OperatorChronicle::Word;
  using Task = OperatorChronicle::Task;

  /// How far a joint has been from where it was at `from_s`, the most, until `to_s`.
  static double moved(const OperatorChronicle& run, double from_s, double to_s) {
    auto row = std::ranges::upper_bound(run.arm, from_s, {}, &Arm::time_s);
    if (row == run.arm.begin()) return 0;
    const std::vector<double>& rested = std::prev(row)->joints;
    double most = 0;
    for (; row != run.arm.end() && row->time_s <= to_s; ++row) {
      for (std::size_t i = 0; i < rested.size(); ++i) {
        most = std::max(most, std::abs(row->joints[i] - rested[i]));
      }
    }
    return most;
  }

  Eigen::Isometry3d tool(const Arm& arm) const {
    return forward_kinematics(robot_, robot_.to_independent(std::span{arm.joints}).value());
  }

  /// What the task tells has the arm rest.
  bool rests(const Task& task) const;
  /// The word may end that.
  static bool lets_move(const Word& word, const Task& task);
  void expect_rest_while_it_waits(const OperatorChronicle& run) const;
  void expect_rest_after_an_abort(const OperatorChronicle& run) const;
  void expect_needle_on_its_line(const OperatorChronicle& run) const;
  void expect_drill_on_its_lines(const OperatorChronicle& run) const;
  static void expect_one_plan(const OperatorChronicle& run);
  static void expect_answers(const OperatorChronicle& run);
  void expect_end(const OperatedRun& operated) const;
  void expect_stops_that_stay(const OperatorChronicle& run) const;

  const RobotModel robot_ = load_robot_model(source_file("configs/robots/" + GetParam().robot));
};

// 1.

bool AnyOperator::rests(const Task& task) const {
  const OperatedSystem& system = GetParam();
  const bool in_hand =
      task.state == "waiting" || task.state == "touching" || task.step == "approach";
  if (system.hand_leads && in_hand) return false;
  return task.asks || task.paused || task.state == "held" ||
         std::ranges::find(system.rests_while, task.state) != system.rests_while.end();
}

bool AnyOperator::lets_move(const Word& word, const Task& task) {
  if (!word.obeyed()) return false;
  if (word.word == "back" || word.word == "abort") return true;
  return task.asks ? word.word == "confirm" : task.paused && word.word == "resume";
}

void AnyOperator::expect_rest_while_it_waits(const OperatorChronicle& run) const {
  std::optional<double> rests_from_s;
  auto word = run.words.begin();
  for (auto task = run.task.begin(); task != run.task.end(); ++task) {
    const auto next = std::next(task);
    const double next_s = next == run.task.end() ? run.end_s : next->time_s;
    if (!rests(*task)) {
      rests_from_s.reset();
      while (word != run.words.end() && word->time_s < next_s) ++word;
      continue;
    }
    if (!rests_from_s) rests_from_s = task->time_s + GetParam().stops_within_s;
    const auto expect_rest = [&](double until_s) {
      EXPECT_LE(moved(run, *rests_from_s, until_s), 1e-6)
          << "from " << *rests_from_s << " s to " << until_s
          << " s: " << (task->paused ? "paused: " : "") << task->state << ' ' << task->step;
    };
    for (; word != run.words.end() && word->time_s < next_s; ++word) {
      if (!lets_move(*word, *task)) continue;
      expect_rest(word->time_s);
      rests_from_s = word->time_s + GetParam().stops_within_s;
    }
    expect_rest(next_s);
  }
}

// 2.

void AnyOperator::expect_rest_after_an_abort(const OperatorChronicle& run) const {
  const OperatedSystem& system = GetParam();
  const auto abort = std::ranges::find_if(
      run.words, [](const Word& word) { return word.word == "abort" && word.obeyed(); });
  if (abort == run.words.end()) return;
  // A run that ends with it may do so before its operator hears of it.
  const auto aborted = std::ranges::find(run.task, "aborted", &Task::state);
  const double aborted_s = aborted == run.task.end() ? run.end_s : aborted->time_s;
  EXPECT_LE(moved(run, aborted_s + system.stops_within_s, run.end_s), 1e-6);
  const auto approach = std::ranges::find_if(
      run.task, [](const Task& task) { return task.asks && task.step == "approach"; });
  const bool led_out = system.leads_out && (system.mishaps == 0 || aborted != run.task.end());
  if (!led_out || approach == run.task.end()) return;
  const auto at = std::ranges::upper_bound(run.arm, approach->time_s, {}, &Arm::time_s);
  ASSERT_NE(at, run.arm.begin());
  const Vector3d began = tool(*std::prev(at)).translation();
  EXPECT_LT((tool(run.arm.back()).translation() - began).norm(), 5e-4)
      << "it comes to where the approach began";
}

// 3.

/// A line into a body, from where it is in it to its end.
struct Line {
  Vector3d end, into;
  double length_m = 0;

  double beside_m(const Vector3d& tip) const {
    const Vector3d from_end = tip - end;
    return (from_end - from_end.dot(into) * into).norm();
  }
  bool is_in(const Vector3d& tip) const {
    constexpr double kSkin_m = 5e-4;
    return (tip - end).dot(into) > kSkin_m - length_m;
  }
};

constexpr double kBeside_m = 1e-4, kNear_m = 0.003;

void AnyOperator::expect_needle_on_its_line(const OperatorChronicle& run) const {
  std::optional<Line> line;
  auto goal = run.goals.begin();
  bool in_head = false;
  for (const Arm& arm : run.arm) {
    for (; goal != run.goals.end() && goal->time_s <= arm.time_s; ++goal) {
      if (!goal->focus) continue;
      const Vector3d target = goal->pose.translation();
      line = Line{.end = target,
                  .into = (target - *goal->focus).normalized(),
                  .length_m = (target - *goal->focus).norm()};
    }
    if (!line) continue;
    const Vector3d tip = tool(arm).translation();
    in_head = line->is_in(tip) && (in_head || line->beside_m(tip) < kNear_m);
    if (!in_head) continue;
    ASSERT_LT(line->beside_m(tip), kBeside_m) << arm.time_s << " s";
    ASSERT_LT((tip - line->end).dot(line->into), kBeside_m)
        << arm.time_s << " s: beyond its target";
  }
}

void AnyOperator::expect_drill_on_its_lines(const OperatorChronicle& run) const {
  constexpr double kSame_m = 1e-5, kAboveBone_m = 0.018;  // stand_off_mm - depth_mm
  struct Site {
    Line line;
    Vector3d above;
  };
  std::vector<Site> sites;  // of one registration and tool
  const auto add = [&](const OperatorChronicle::Goal& goal) {
    const Vector3d at = goal.pose.translation(), into = goal.pose.linear().col(2);
    const auto known = std::ranges::find_if(
        sites, [&](const Site& site) { return site.line.beside_m(at) < kSame_m; });
    if (known == sites.end()) {
      sites.push_back({.line = {.end = at, .into = into, .length_m = 0}, .above = at});
      return;
    }
    if ((at - known->line.end).dot(into) > 0) known->line.end = at;
    if ((at - known->above).dot(into) < 0) known->above = at;
    known->line.length_m = (known->line.end - known->above).dot(into) - kAboveBone_m;
  };
  auto goal = run.goals.begin();
  auto task = run.task.begin();
  std::size_t in = 0;  // from 1; 0: in none
  for (const Arm& arm : run.arm) {
    for (; task != run.task.end() && task->time_s <= arm.time_s; ++task) {
      if (task->state == "registering" || task->state == "changing tool") {
        sites.clear();
        in = 0;
      }
    }
    for (; goal != run.goals.end() && goal->time_s <= arm.time_s; ++goal) add(*goal);
    const Vector3d tip = tool(arm).translation();
    for (std::size_t i = 0; i < sites.size() && in == 0; ++i) {
      const Line& line = sites[i].line;
      if (line.length_m > 0 && line.is_in(tip) && line.beside_m(tip) < kNear_m) in = i + 1;
    }
    if (in == 0) continue;
    const Line& line = sites[in - 1].line;
    if (!line.is_in(tip)) {
      in = 0;
      continue;
    }
    ASSERT_LT(line.beside_m(tip), kBeside_m) << "at " << arm.time_s << " s, site line " << in;
    ASSERT_LT((tip - line.end).dot(line.into), kBeside_m) << "at " << arm.time_s << " s: too deep";
  }
}

void AnyOperator::expect_one_plan(const OperatorChronicle& run) {
  constexpr double kSame_m = 1e-6;
  const OperatorChronicle::Goal* first = nullptr;
  for (const auto& goal : run.goals) {
    if (!goal.focus) continue;
    if (!first) first = &goal;
    EXPECT_LT((goal.pose.translation() - first->pose.translation()).norm(), kSame_m)
        << "at " << goal.time_s << " s the needle goes to another target";
    EXPECT_LT((*goal.focus - *first->focus).norm(), kSame_m) << "by another entry";
  }
}

// 4.

void AnyOperator::expect_answers(const OperatorChronicle& run) {
  constexpr double kAnswered_s = 0.3;
  const std::string last = run.task.empty() ? "" : run.task.back().state;
  const bool is_over = last == "refused" || last == "aborted";
  for (const Word& word : run.words) {
    if (word.time_s + kAnswered_s > (is_over ? run.task.back().time_s : run.end_s)) continue;
    EXPECT_TRUE(word.answer) << "no answer to '" << word.word << "' of " << word.time_s << " s";
    if (word.answer) {
      EXPECT_LT(word.answered_s - word.time_s, kAnswered_s);
    }
  }
}

void AnyOperator::expect_end(const OperatedRun& operated) const {
  const std::string status = operated.run.status(), report = operated.run.report;
  const auto& words = operated.chronicle.words;
  const auto abort = std::ranges::find_if(words, [](const Word& word) {
    return word.word == "abort" && (!word.answer || word.obeyed());
  });
  if (status == "aborted") {
    EXPECT_NE(abort, words.end()) << report;
    return;
  }
  if (GetParam().mishaps > 0) {
    // Nobody leads a needle out by hand that has come off its way without power, or makes a lamp
    // search again.
    const std::string left = operated.chronicle.task.back().state;
    const bool is_left = left == "held" || left == "unreachable";
    EXPECT_TRUE(!GetParam().ends_well || is_left || status == "ok" || status == "refused")
        << report;
    return;
  }
  constexpr double kEndsWithin_s = 0.5;  // a run that is over, since arms and hands come to rest
  EXPECT_TRUE(abort == words.end() || !abort->answer ||
              abort->time_s + kEndsWithin_s > operated.chronicle.end_s)
      << report;
  const bool is_known = status == "refused" && !GetParam().but_for.empty() &&
                        operated.run.word("reason").starts_with(GetParam().but_for);
  if (!GetParam().ends_well || is_known) return;
  EXPECT_EQ(status, "ok") << report;
  EXPECT_EQ(operated.run.command.exit_code, 0) << report;
}

// 6.

void AnyOperator::expect_stops_that_stay(const OperatorChronicle& run) const {
  std::optional<double> stopped_s;
  for (auto mishap = run.mishaps.begin(); mishap != run.mishaps.end(); ++mishap) {
    if (mishap->what == "stopped") stopped_s = mishap->time_s;
    if (mishap->what != "not stopped" || !stopped_s) continue;
    const auto word = std::ranges::find_if(run.words, [&](const Word& said) {
      return said.time_s > mishap->time_s && said.obeyed() && said.word != "pause";
    });
    const double until_s = word == run.words.end() ? run.end_s : word->time_s;
    EXPECT_LE(moved(run, *stopped_s + GetParam().stops_within_s, until_s), 1e-6)
        << "stopped at " << *stopped_s << " s, rearmed at " << mishap->time_s
        << " s, no word until " << until_s << " s";
    stopped_s.reset();
  }
  if (!stopped_s) return;
  EXPECT_LE(moved(run, *stopped_s + GetParam().stops_within_s, run.end_s), 1e-6)
      << "stopped at " << *stopped_s << " s";
}

TEST_P(AnyOperator, LetsNoArmMoveOtherwiseThanItMay) {
  const int first = environment_number("ARMATURE_FIRST_OPERATOR", 1),
            count = environment_number("ARMATURE_OPERATORS", GetParam().seeds);
  for (int seed = first; seed < first + count; ++seed) {
    const OperatedRun operated = run_with(GetParam(), seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + "\n" + operated.chronicle.story());
    expect_rest_while_it_waits(operated.chronicle);
    expect_rest_after_an_abort(operated.chronicle);
    if (GetParam().body == Body::head) expect_needle_on_its_line(operated.chronicle);
    if (GetParam().body == Body::jaw) expect_drill_on_its_lines(operated.chronicle);
    if (GetParam().body == Body::incision) {
      EXPECT_LT(operated.run.figure("incision_deviation_mm"), 0.2);
    }
    if (GetParam().plan_changes) expect_one_plan(operated.chronicle);
    expect_answers(operated.chronicle);
    expect_end(operated);
    if (!GetParam().hand_leads) expect_stops_that_stay(operated.chronicle);
    if (seed > first || GetParam().name == "Lamp") continue;  // its cameras take too long
    EXPECT_FALSE(operated.chronicle.words.empty());
    EXPECT_TRUE(run_with(GetParam(), seed).chronicle.text == operated.chronicle.text)
        << "the same operator gives the same run";
  }
}

INSTANTIATE_TEST_SUITE_P(Of, AnyOperator, testing::ValuesIn(operated_systems()),
                         [](const auto& system) { return system.param.name; });

}  // namespace
}  // namespace armature::test
