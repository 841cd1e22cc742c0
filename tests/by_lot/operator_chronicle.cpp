// SPDX-License-Identifier: Apache-2.0
#include "operator_chronicle.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace armature::test {
namespace {

using Chronicle = OperatorChronicle;

std::string rest_of(std::istream& line) {
  std::string rest;
  std::getline(line, rest);
  return rest;
}

/// Up to the next bar.
std::string field(std::istream& line) {
  std::string text;
  std::getline(line, text, '|');
  return text;
}

Chronicle::Arm arm_of(std::istream& line, double time_s) {
  Chronicle::Arm arm{.time_s = time_s, .joints = {}};
  for (double q = 0; line >> q;) arm.joints.push_back(q);
  return arm;
}

std::optional<Chronicle::Goal> goal_of(std::istream& line, double time_s) {
  constexpr int kPlanned = 0;
  std::uint64_t id = 0;
  int mode = 0;
  bool has_focus = false;
  Eigen::Vector3d p, focus;
  Eigen::Quaterniond q;
  line >> id >> mode >> p.x() >> p.y() >> p.z() >> q.x() >> q.y() >> q.z() >> q.w() >> has_focus >>
      focus.x() >> focus.y() >> focus.z();
  EXPECT_TRUE(line);
  if (mode != kPlanned) return std::nullopt;
  Chronicle::Goal goal{.time_s = time_s, .focus = {}};
  goal.pose = Eigen::Translation3d{p} * q;
  if (has_focus) goal.focus = focus;
  return goal;
}

Chronicle::Task task_of(std::istream& line, double time_s) {
  Chronicle::Task task{.time_s = time_s, .state = {}, .step = {}, .detail = {}};
  line >> task.asks >> task.paused;
  EXPECT_EQ(field(line), "");
  task.state = field(line);
  task.step = field(line);
  task.detail = rest_of(line);
  return task;
}

/// The word that a line of that kind has for a stop; empty: it tells of none.
std::string mishap_of(const std::string& kind, std::istream& line) {
  if (kind == "over" || kind == "rearmed") return kind;
  std::string what;
  if (kind == "mishap" || kind == "stopped") line >> what;
  if (kind == "stopped") return what == "1" ? "stopped" : "not stopped";
  return what;
}

void answer(Chronicle& chronicle, std::istream& line, double time_s) {
  std::uint64_t id = 0;
  line >> id;
  EXPECT_EQ(field(line), "");
  const auto said = std::ranges::find(chronicle.words, id, &Chronicle::Word::id);
  if (said == chronicle.words.end() || said->answer) return;
  said->answer = rest_of(line);
  said->answered_s = time_s;
}

}  // namespace

Chronicle read_operator_chronicle(const std::string& text) {
  Chronicle chronicle{.text = text, .arm = {}, .goals = {}, .task = {}, .words = {}, .mishaps = {}};
  std::istringstream lines{text};
  for (std::string one; std::getline(lines, one);) {
    std::istringstream line{one};
    std::string kind;
    double time_s = 0;
    line >> kind >> time_s;
    EXPECT_TRUE(line) << one;
    chronicle.end_s = time_s;
    if (const std::string what = mishap_of(kind, line); !what.empty()) {
      chronicle.mishaps.push_back({.time_s = time_s, .what = what});
    }
    if (kind == "arm") chronicle.arm.push_back(arm_of(line, time_s));
    if (kind == "task") chronicle.task.push_back(task_of(line, time_s));
    if (kind == "answered") answer(chronicle, line, time_s);
    if (kind == "goal") {
      if (const auto goal = goal_of(line, time_s)) chronicle.goals.push_back(*goal);
    }
    if (kind == "said") {
      Chronicle::Word word{.time_s = time_s, .word = {}, .step = {}, .answer = {}};
      line >> word.id >> std::ws;
      word.word = field(line);
      word.step = rest_of(line);
      chronicle.words.push_back(word);
    }
  }
  return chronicle;
}

std::string Chronicle::story() const {
  std::string story;
  auto said = words.begin();
  auto mishap = mishaps.begin();
  const auto tell_mishaps = [&](double until_s) {
    for (; mishap != mishaps.end() && mishap->time_s <= until_s; ++mishap) {
      story += fmt::format("{:9.3f} s  -- {}\n", mishap->time_s, mishap->what);
    }
  };
  const auto tell_words = [&](double until_s) {
    for (; said != words.end() && said->time_s <= until_s; ++said) {
      tell_mishaps(said->time_s);
      story += fmt::format("{:9.3f} s  says {} {}: {}\n", said->time_s, said->word, said->step,
                           !said->answer           ? "not answered"
                           : said->answer->empty() ? "obeyed"
                                                   : *said->answer);
    }
  };
  for (const Task& told : task) {
    tell_words(told.time_s);
    tell_mishaps(told.time_s);
    story += fmt::format("{:9.3f} s  {}{} {} {}\n", told.time_s, told.paused ? "paused: " : "",
                         told.state, told.asks ? "asks for '" + told.step + "'" : "", told.detail);
  }
  tell_words(end_s);
  tell_mishaps(end_s);
  return story;
}

}  // namespace armature::test
