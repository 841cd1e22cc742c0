// SPDX-License-Identifier: Apache-2.0
// A question that is written, answered and read again is the question, and so is the answer.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>

#include "armature/kinds/ik/lines/answering.hpp"
#include "armature/kinds/ik/lines/asking.hpp"

namespace armature {
namespace {

using Code = IkStatus::Code;
using json = nlohmann::ordered_json;

const RobotModel& lamp() {
  static const RobotModel model =
      load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml");
  return model;
}

/// Remembers what it was asked and answers what it was told to.
class Parrot final : public IkSolver {
 public:
  IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                 IkState& state) const override {
    asked_goal = goal, asked_seed = seed, asked_state = state;
    out = branches;
    if (remembers) state.last_redundancy = *remembers;
    return status;
  }
  bool redundancy_is_length() const override { return is_length; }

  mutable IkGoal asked_goal;
  mutable JointVector asked_seed;
  mutable IkState asked_state;
  std::optional<double> remembers;
  IkStatus status;
  IkBranches branches;
  bool is_length = false;
};

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }
bool same_bits(const auto& a, const auto& b) {
  if (a.size() != b.size()) return false;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    if (!same_bits(a[i], b[i])) return false;
  }
  return true;
}

class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : random_{seed} {}
  /// Of any size, zeros of both signs among them.
  double any() {
    if (below(8) == 0) return below(2) == 0 ? 0.0 : -0.0;
    return std::normal_distribution{}(random_)*std::pow(10.0, below(20) - 12);
  }
  int below(int end) { return std::uniform_int_distribution{0, end - 1}(random_); }
  Eigen::Vector3d vector() { return {any(), any(), any()}; }
  /// Unit to rounding, which the lines leave as it is.
  Eigen::Vector3d unit() {
    for (;;) {
      const Eigen::Vector3d v{std::normal_distribution{}(random_), any(), any()};
      const Eigen::Vector3d made = v.stableNormalized();
      if (std::abs(made.norm() - 1) <= 1e-15) return made;
    }
  }
  Eigen::Quaterniond rotation() {
    for (;;) {
      Eigen::Quaterniond made{any(), any(), any(), std::normal_distribution{}(random_)};
      made.normalize();
      if (std::abs(made.norm() - 1) <= 1e-15) return made;
    }
  }
  JointVector joints(int count) {
    JointVector q(count);
    for (double& value : q) value = any();
    return q;
  }

 private:
  std::mt19937_64 random_;
};

IkQuestion random_question(Numbers& random) {
  IkQuestion question{.goal = {}, .seed = random.joints(lamp().dof()), .id = random.below(1000)};
  question.goal.pose.position = random.vector();
  if (random.below(2) == 0) {
    question.goal.pose.orientation = Direction{random.unit()};
  } else {
    question.goal.pose.orientation = random.rotation();
  }
  question.redundancy_is_length = random.below(2) == 0;
  if (random.below(2) == 0) question.goal.redundancy = random.any();
  if (random.below(2) == 0) question.state.last_redundancy = random.any();
  if (random.below(2) == 0) question.goal.max_iterations = 1 + random.below(1 << 30);
  if (random.below(2) == 0) question.goal.tolerance.position_m = std::abs(random.any()) + 1e-15;
  if (random.below(2) == 0) question.goal.tolerance.angle_rad = std::abs(random.any()) + 1e-15;
  return question;
}

TEST(IkLines, AQuestionArrivesBitForBit) {
  SCOPED_TRACE("seed 71");
  Numbers random{71};
  for (int i = 0; i < 2000; ++i) {
    const IkQuestion question = random_question(random);
    Parrot solver;
    solver.is_length = question.redundancy_is_length;
    const std::string line = question_line(lamp(), question);
    const json answer =
        json::parse(answer_ik(lamp(), solver, JointVector::Zero(lamp().dof()), line));
    ASSERT_EQ(answer["status"], "ok") << line << answer;
    EXPECT_EQ(answer["id"], *question.id);
    const IkGoal &sent = question.goal, &got = solver.asked_goal;
    EXPECT_TRUE(same_bits(got.pose.position, sent.pose.position)) << line;
    ASSERT_EQ(got.pose.orientation.index(), sent.pose.orientation.index());
    if (const auto* direction = std::get_if<Direction>(&sent.pose.orientation)) {
      EXPECT_TRUE(same_bits(std::get<Direction>(got.pose.orientation).unit, direction->unit));
    } else {
      EXPECT_TRUE(same_bits(std::get<Eigen::Quaterniond>(got.pose.orientation).coeffs(),
                            std::get<Eigen::Quaterniond>(sent.pose.orientation).coeffs()));
    }
    ASSERT_EQ(got.redundancy.has_value(), sent.redundancy.has_value());
    EXPECT_TRUE(same_bits(got.redundancy.value_or(0), sent.redundancy.value_or(0)));
    EXPECT_TRUE(same_bits(got.tolerance.position_m, sent.tolerance.position_m));
    EXPECT_TRUE(same_bits(got.tolerance.angle_rad, sent.tolerance.angle_rad));
    EXPECT_EQ(got.max_iterations, sent.max_iterations) << line;
    const auto last = solver.asked_state.last_redundancy;
    ASSERT_EQ(last.has_value(), question.state.last_redundancy.has_value()) << line;
    EXPECT_TRUE(same_bits(last.value_or(0), question.state.last_redundancy.value_or(0))) << line;
    EXPECT_EQ(solver.asked_seed, question.seed) << line;
  }
}

TEST(IkLines, AnAnswerIsReadBitForBit) {
  SCOPED_TRACE("seed 72");
  Numbers random{72};
  constexpr std::array kCodes{Code::ok,       Code::out_of_reach,   Code::joint_limit,
                              Code::singular, Code::no_convergence, Code::invalid_input};
  for (int i = 0; i < 2000; ++i) {
    const bool is_length = random.below(2) == 0;
    const IkQuestion question{.goal = {},
                              .seed = JointVector::Zero(lamp().dof()),
                              .redundancy_is_length = is_length,
                              .id = i};
    Parrot solver;
    solver.is_length = is_length;
    if (random.below(2) == 0) solver.remembers = random.any();
    solver.status.code = kCodes[static_cast<std::size_t>(random.below(6))];
    const bool measured =
        solver.status.code == Code::out_of_reach || solver.status.code == Code::no_convergence;
    if (measured && random.below(2) == 0) solver.status.shortfall = std::abs(random.any());
    if (random.below(3) > 0) solver.status.detail = "the wrist (x) is 0.1 m too far (residual";
    for (int b = random.below(IkBranches::kCapacity + 1); b > 0; --b) {
      IkBranch& branch = solver.branches.add();
      branch.label = b % 2 == 0 ? "even" : "odd \"and\" \\ quoted";
      branch.q = random.joints(lamp().dof());
    }
    const std::string line =
        answer_ik(lamp(), solver, question.seed, question_line(lamp(), question));
    const auto told = read_answer(lamp(), question, line);
    ASSERT_TRUE(told) << told.error().text << line;
    EXPECT_EQ(told->code, solver.status.code);
    EXPECT_TRUE(same_bits(told->shortfall, solver.status.shortfall)) << line;
    ASSERT_EQ(told->state.last_redundancy.has_value(), solver.remembers.has_value()) << line;
    EXPECT_TRUE(same_bits(told->state.last_redundancy.value_or(0), solver.remembers.value_or(0)));
    EXPECT_EQ(told->detail, told->code == Code::ok ? "" : solver.status.detail) << line;
    ASSERT_EQ(told->solutions.size(), static_cast<std::size_t>(solver.branches.count));
    for (std::size_t b = 0; b < told->solutions.size(); ++b) {
      EXPECT_EQ(told->solutions[b].label, solver.branches.branch[b].label);
      EXPECT_EQ(told->solutions[b].q, solver.branches.branch[b].q);
    }
  }
}

TEST(IkLines, WithoutASeedTheArmStartsFromHome) {
  const Parrot solver;
  const JointVector home = JointVector::Constant(lamp().dof(), 0.25);
  answer_ik(lamp(), solver, home, R"({"position_m":[1,0,0.5],"direction":[1,0,0]})");
  EXPECT_EQ(solver.asked_seed, home);
}

TEST(IkLines, AnUnknownUnitOrANumberThatIsNoneIsRefused) {
  Parrot solver;
  const auto refusal_of = [&](const char* key) {
    const std::string line =
        std::string{R"({"position_m":[1,0,0.5],"direction":[1,0,0],)"} + key + "}";
    const json answer =
        json::parse(answer_ik(lamp(), solver, JointVector::Zero(lamp().dof()), line));
    return answer["status"] == "ok" ? "" : answer["reason"].get<std::string>();
  };
  const std::string wrong = "'max_iterations' must be a whole number from 1 to 2147483647";
  EXPECT_EQ(refusal_of(R"("max_iterations":0)"), wrong);
  EXPECT_EQ(refusal_of(R"("max_iterations":1)"), "");
  EXPECT_EQ(refusal_of(R"("max_iterations":2147483647)"), "");
  EXPECT_EQ(refusal_of(R"("max_iterations":2147483648)"), wrong);
  EXPECT_EQ(refusal_of(R"("max_iterations":18446744073709551615)"), wrong);
  EXPECT_EQ(refusal_of(R"("max_iterations":-1)"), wrong);
  EXPECT_EQ(refusal_of(R"("max_iterations":2.5)"), wrong);
  EXPECT_EQ(refusal_of(R"("last_redundancy_rad":0.5)"), "");
  EXPECT_EQ(refusal_of(R"("last_redundancy_rad":null)"), "'last_redundancy_rad' must be a number");
  EXPECT_EQ(refusal_of(R"("last_redundancy_m":0.5)"),
            "'last_redundancy_m' is 'last_redundancy_rad' for this solver");
}

TEST(IkLines, WhatASolverRemembersComesBackEvenWhenItIsWhatItWas) {
  const Parrot solver;
  const std::string answer =
      answer_ik(lamp(), solver, JointVector::Zero(lamp().dof()),
                R"({"position_m":[1,0,0.5],"direction":[1,0,0],"last_redundancy_rad":0.1})");
  EXPECT_EQ(json::parse(answer)["last_redundancy_rad"], 0.1);
}

TEST(IkLines, TheRedundancyIsToldWhereTheGoalLeavesOneToTheSolver) {
  class Needle final : public IkSolver {
   public:
    IkStatus solve(const IkGoal&, const JointVector& seed, IkBranches& out,
                   IkState&) const override {
      out.clear();
      out.add() = {.label = "only", .q = seed, .redundancy = 0.25};
      return {};
    }
    std::optional<double> redundancy_of(const JointVector& q) const override { return q[5]; }
    bool redundancy_is_length() const override { return true; }
  };
  const RobotModel arm = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/sr1_needle.yaml");
  const auto solution = [&](const std::string& orientation) {
    const std::string line = R"({"position_m":[1,0,0.5],)" + orientation + "}";
    return json::parse(answer_ik(arm, Needle{}, resting_position(arm), line))["solutions"][0];
  };
  EXPECT_EQ(solution(R"("direction":[1,0,0])")["redundancy_m"], 0.25);
  EXPECT_FALSE(solution(R"("quaternion_xyzw":[0,0,0,1])").contains("redundancy_m"));
}

TEST(IkLines, AnIdComesBackWhateverBecameOfTheQuestion) {
  const Parrot solver;
  const JointVector home = JointVector::Zero(lamp().dof());
  const auto id_of = [](const std::string& answer) { return json::parse(answer)["id"]; };
  const auto ik = [&](const char* line) { return answer_ik(lamp(), solver, home, line); };
  EXPECT_EQ(id_of(ik(R"({"id":7,"position_m":[1,0,0.5],"direction":[1,0,0]})")), 7);
  EXPECT_EQ(id_of(ik(R"({"id":"a b","position_m":[1,0,0.5]})")), "a b");
  EXPECT_EQ(id_of(ik(R"({"id":-1,"positoin_m":[1,0,0.5]})")), -1);
  EXPECT_EQ(id_of(answer_fk(lamp(), R"({"joints":[0,0,0,0,0,0],"id":2.5})")), 2.5);
  EXPECT_EQ(json::parse(ik(R"({"id":[1],"position_m":[1,0,0.5]})"))["reason"],
            "'id' must be a number or a text");
}

TEST(IkLines, AnUnknownKeyIsToldWithTheOneThatIsMeant) {
  const auto reason = [](const std::string& line) {
    return json::parse(answer_fk(lamp(), line))["reason"].get<std::string>();
  };
  EXPECT_EQ(reason(R"({"q":[0,0,0,0,0,0]})"), "unknown key 'q'; known: joints");
  EXPECT_EQ(reason(R"({"joint":[0,0,0,0,0,0]})"), "unknown key 'joint'; did you mean 'joints'?");
}

TEST(IkLines, ACommentIsNamedAndAByteOrderMarkIsNoHarm) {
  const auto fk = [](const std::string& line) { return json::parse(answer_fk(lamp(), line)); };
  EXPECT_EQ(fk(" # all joints at home")["reason"], "a comment, which JSON lines do not have");
  EXPECT_TRUE(fk("\xEF\xBB\xBF{\"joints\":[0,0,0,0,0,0]}").contains("position_m"));
}

TEST(IkLines, WhatIsNestedDeeplyIsRefused) {
  constexpr std::size_t kDeep = 400'000;
  const std::string open(kDeep, '['), nested = open + std::string(kDeep, ']');
  const auto reason = [](const std::string& line) {
    return json::parse(answer_fk(lamp(), line))["reason"].get<std::string>();
  };
  for (const std::string& line :
       {open, nested, R"({"id":)" + nested + "}", R"({"joints":[0,0,0,0,0,)" + nested + "]}"}) {
    EXPECT_EQ(reason(line), "nested too deeply") << line.substr(0, 40);
  }
  EXPECT_EQ(reason(R"({"id":)" + std::string(31, '[') + std::string(31, ']') + "}"),
            "'id' must be a number or a text");
}

TEST(IkLines, ANumberBeyondAllMeasureIsRefusedByItsPlace) {
  const auto fk = [](const std::string& line) {
    return json::parse(answer_fk(lamp(), line))["reason"].get<std::string>();
  };
  const auto ik = [](const std::string& line) {
    const Parrot solver;
    const JointVector home = JointVector::Zero(lamp().dof());
    return json::parse(answer_ik(lamp(), solver, home, line))["reason"].get<std::string>();
  };
  const std::string goal = R"({"position_m":[1,0,0.5],"direction":[1,0,0],)";
  EXPECT_EQ(fk(R"({"joints":[0,0,0,0,0,1e400]})"),
            "'joints' has a number that a double cannot hold");
  EXPECT_EQ(ik(R"({"direction":[1,0,0],"position_m":[-1e400,0,0.5]})"),
            "'position_m' has a number that a double cannot hold");
  EXPECT_EQ(fk(R"({"joints":[1e300,0,0,0,0,0]})"), "'joints' is more than 1e100");
  EXPECT_EQ(ik(goal + R"("seed":[-1e300,0,0,0,0,0]})"), "'seed' is more than 1e100");
  EXPECT_EQ(ik(goal + R"("redundancy_rad":1e300})"), "'redundancy_rad' is more than 1e100");
  EXPECT_EQ(ik(goal + R"("last_redundancy_rad":-1e300})"),
            "'last_redundancy_rad' is more than 1e100");
}

std::string refusal(const std::string& answer) {
  const IkQuestion question{.goal = {}, .seed = {}, .id = 7};
  const auto told = read_answer(lamp(), question, answer);
  return told ? "" : told.error().text;
}

TEST(IkLines, WhatIsNoAnswerIsRefusedAndShown) {
  EXPECT_EQ(refusal("Loading model..."), "not JSON: 'Loading model...'");
  EXPECT_EQ(refusal("\x1b[1m\xff" + std::string(100, 'x')),
            "not JSON: '?[1m?" + std::string(55, 'x') + "...'");
  EXPECT_EQ(refusal("[1]"), "not a JSON object: '[1]'");
  EXPECT_EQ(refusal(R"({"status":"ok","solutions":[]})"),
            R"(without the 'id' of the question, 7: '{"status":"ok","solutions":[]}')");
  EXPECT_EQ(refusal(R"({"id":6,"status":"ok"})"),
            R"(question 6, and 7 was asked: '{"id":6,"status":"ok"}')");
  EXPECT_EQ(refusal(R"({"id":"7","status":"ok"})"),
            R"(question "7", and 7 was asked: '{"id":"7","status":"ok"}')");
  EXPECT_EQ(refusal(R"({"id":7})"), R"(without a 'status': '{"id":7}')");
  EXPECT_EQ(refusal(R"({"id":7,"status":"out_of_raech"})"),
            R"(with the status "out_of_raech"; did you mean 'out_of_reach'?: )"
            R"('{"id":7,"status":"out_of_raech"}')");
  EXPECT_EQ(refusal(R"({"id":7,"status":"ok","status":"ok"})"),
            R"('status' is given twice: '{"id":7,"status":"ok","status":"ok"}')");
  EXPECT_EQ(refusal(R"({"id":7,"status":"ok","solutions":5})"),
            R"(with 'solutions' that are no list: '{"id":7,"status":"ok","solutions":5}')");
  EXPECT_EQ(refusal(std::string(400'000, '[')),
            "nested too deeply: '" + std::string(60, '[') + "...'");
}

TEST(IkLines, ASolutionThatTheRobotCannotStandInIsRefusedByItsPlace) {
  const auto with = [](const std::string& solutions) {
    const std::string text = refusal(R"({"id":7,"status":"ok","solutions":[)" + solutions + "]}");
    return text.substr(0, text.find(": '{"));
  };
  const std::string good = R"({"joints":[0,0,0,0,0,0]})";
  EXPECT_EQ(with(good), "");
  EXPECT_EQ(with(good + R"(,{"joints":[0,0,0]})"),
            "with solution 2 of 2: 'joints' has 3 numbers, must have 6");
  EXPECT_EQ(with(R"({"joints":[0,0,0,0,0,null]})"),
            "with solution 1 of 1: 'joints' must be a list of numbers");
  EXPECT_EQ(with(R"({"joints":[0,0,0,0,0,NaN]})"), "not JSON");
  EXPECT_EQ(with(R"({"joints":[0,0,1,0,0,0]})"),
            "with solution 1 of 1: j4 = 0 contradicts its coupling to j3, which makes it -1");
  EXPECT_EQ(with(R"({"label":"up"})"), "with solution 1 of 1: 'joints' is missing");
  EXPECT_EQ(with(R"({"label":5,"joints":[0,0,0,0,0,0]})"),
            "with solution 1 of 1: 'label' must be a text");
  EXPECT_EQ(with("[]"), "with solution 1 of 1: it is not an object");
  std::string many = good;
  for (int i = 0; i < 16; ++i) many += "," + good;
  EXPECT_EQ(with(many), "with 17 solutions, at most 16 are read");
}

}  // namespace
}  // namespace armature
