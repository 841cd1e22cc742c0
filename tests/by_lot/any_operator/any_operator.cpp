// SPDX-License-Identifier: Apache-2.0
// The chronicle has a line per thing, in the order in which they were seen, times in s:
//   arm TIME q...                                   every hundredth of a second while it changes
//   goal TIME id mode x y z qx qy qz qw focus x y z; one for each key pose, too
//   motion TIME id state
//   task TIME ASKS PAUSED|state|step|detail         each change
//   said TIME id word|step
//   answered TIME id|why it was refused
//   mishap TIME what stops the arm; over TIME; rearmed TIME
//   stopped TIME 1: motion tells so from then on; 0: no more
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/header.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/std_msgs.hpp"
#include "armature/motion/goal.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/values/chance.hpp"
#include "test_any_operator_parameters.hpp"
#include "test_any_operator_ports.hpp"

namespace armature::test::any_operator {
namespace {

constexpr Duration kPeriod = seconds(0.001);
constexpr Duration kRow = seconds(0.01);

/// Things that stop an arm: a button, the pedal that is let go, its drives without power.
enum class Mishap { stop, hold, power };
constexpr const char* kMishaps[] = {"stop", "hold", "power"};

/// The step that waits for its confirmation; empty: none.
std::string question_of(const msg::TaskState& state) {
  constexpr std::uint8_t kAsks = 1;
  for (const msg::TaskStep& step : state.procedure_()) {
    if (step.state_() == kAsks) return step.name_();
  }
  return "";
}

}  // namespace

class AnyOperator final : public Component {
 public:
  explicit AnyOperator(Setup& setup)
      : Component{setup},
        parameters_{Parameters::read(setup.params())},
        ports_{setup},
        chance_{parameters_.seed},
        misfortune_{parameters_.seed + 1'000'000},
        chronicle_{std::filesystem::path{parameters_.file}} {
    if (!chronicle_) throw SetupError("cannot write " + parameters_.file);
    setup.activate_every(kPeriod);
    waits_for_a_question_ = happens(0.5);
    if (parameters_.aborts) abort_ = below(parameters_.words);
  }

  void step(Time now) override {
    if (!start_) start_ = now;
    write_arm(now);
    for (std::size_t i = 0; i < ports_.goal.size(); ++i) write_goal(ports_.goal[i], now);
    for (std::size_t i = 0; i < ports_.state.size(); ++i) see(ports_.state[i], now);
    for (std::size_t i = 0; i < ports_.status.size(); ++i) see(ports_.status[i], now);
    hold(now);
    if (!met_) return;
    meet_mishaps(now);
    constexpr double kEvery_s = 4;
    if (happens(to_seconds(kPeriod) / kEvery_s)) talk(now);
    be_patient(now);
    for (std::size_t i = 0; i < planned_.size();) {
      if (planned_[i].at > now) {
        ++i;
        continue;
      }
      const Planned due = planned_[i];
      planned_.erase(planned_.begin() + static_cast<std::ptrdiff_t>(i));
      say(due, now);
    }
  }

 private:
  struct Planned {
    Time at;
    std::string word;                                // empty: any
    std::optional<msg::OperatorCommand> again = {};  // as it was told before
  };

  double share() { return chance_.share(); }
  bool happens(double probability) { return chance_.happens(probability); }
  std::uint64_t below(std::uint64_t count) {
    return static_cast<std::uint64_t>(share() * static_cast<double>(count));
  }
  template <std::size_t n>
  std::size_t one_of(const double (&weights)[n]) {
    double rest = share();
    for (std::size_t i = 0; i + 1 < n; ++i) {
      if (rest < weights[i]) return i;
      rest -= weights[i];
    }
    return n - 1;
  }

  bool is_calm() const { return said_ >= parameters_.words; }

  /// One word or several, now or soon.
  void talk(Time now) {
    if (is_calm() || (waits_for_a_question_ && question_.empty() && before_.empty())) return;
    const auto words = 1 + one_of({0.6, 0.3, 0.1});
    for (std::size_t i = 0; i < words; ++i) {
      const double longest_s[] = {0, 0.04, 1};
      const double delay_s = longest_s[one_of({0.5, 0.3, 0.2})] * share();
      planned_.push_back({.at = now + seconds(delay_s), .word = ""});
    }
  }

  /// What lets the task go on, so that no run is without end.
  void be_patient(Time now) {
    const bool waits = paused_ || !question_.empty() || state_ == "held";
    if (!waits) waits_since_ = now;
    if (now - waits_since_ < seconds(2.5)) return;
    waits_since_ = now;
    planned_.push_back({.at = now,
                        .word = paused_            ? "resume"
                                : state_ == "held" ? "abort"
                                                   : "confirm"});
  }

  std::string any_word() {
    if (abort_ && said_ >= *abort_) {
      abort_.reset();
      return "abort";
    }
    const char* words[] = {"confirm", "pause", "resume", "back", "go"};
    return words[one_of({0.32, 0.23, 0.23, 0.2, 0.02})];
  }

  /// Mostly of what waits now; else of what waited before, or of something else.
  std::string any_step() {
    const std::string steps[] = {question_, before_, "site 1", ""};
    return steps[one_of({0.75, 0.15, 0.05, 0.05})];
  }

  void say(const Planned& planned, Time now) {
    msg::OperatorCommand command;
    if (planned.again) {
      command = *planned.again;
    } else {
      const bool any = planned.word.empty();
      if (any && is_calm()) return;
      command.command_id_(++last_id_);
      command.command_() = any ? any_word() : planned.word;
      if (command.command_() == "confirm") command.step_() = any ? any_step() : question_;
      const double late_s[] = {0, 0.9 * share(), 1.5, -1.5};
      const double late = any ? late_s[one_of({0.92, 0.04, 0.02, 0.02})] : 0;
      write_header(command.header_(), now - seconds(late));
      ++said_;
      if (happens(0.1)) {
        planned_.push_back({.at = now + seconds(0.3 * share()), .word = "", .again = command});
      }
      write("said {:.3f} {} {}|{}", time(now), command.command_id_(), command.command_(),
            command.step_());
    }
    auto loan = ports_.operator_.loan();
    *loan = command;
    loan.publish();
  }

  /// The pedal, fifty times a second.
  void hold(Time now) {
    if (now < hold_at_) return;
    hold_at_ = now + seconds(0.02);
    tell(ports_.hold_to_run, mishap_ != Mishap::hold);
  }

  void meet_mishaps(Time now) {
    constexpr double kEvery_s = 6;
    const bool asked = !question_.empty() || !before_.empty();
    if (mishap_) {
      if (now >= mishap_over_) end_mishap(now);
    } else if (asked && mishaps_ < parameters_.mishaps && !is_calm() &&
               misfortune_.share() < to_seconds(kPeriod) / kEvery_s) {
      begin_mishap(now);
    }
    if (!mishap_ && (stopped_ || rearms_) && now >= rearm_at_) {
      rearms_ = false;
      rearm_at_ = now + seconds(1.5);
      tell(ports_.rearm, true);
      write("rearmed {:.3f}", time(now));
    }
  }

  void begin_mishap(Time now) {
    ++mishaps_;
    mishap_ = Mishap(static_cast<int>(3 * misfortune_.share()));
    mishap_over_ = now + seconds(2 * misfortune_.share());
    write("mishap {:.3f} {}", time(now), kMishaps[static_cast<int>(*mishap_)]);
    if (mishap_ == Mishap::stop) tell(ports_.stop, true);
    if (mishap_ == Mishap::hold) tell(ports_.hold_to_run, false);
    if (mishap_ == Mishap::power) tell(ports_.power, false);
  }

  void end_mishap(Time now) {
    if (mishap_ == Mishap::power) tell(ports_.power, true);
    mishap_.reset();
    rearms_ = true;  // also where nothing was moved yet, and motion calls nothing stopped
    rearm_at_ = now + seconds(3 * misfortune_.share());
    write("over {:.3f}", time(now));
  }

  static void tell(Output<msg::Bool>& output, bool told) {
    auto loan = output.loan();
    loan->data_(told);
    loan.publish();
  }

  void see(const msg::TaskState& state, Time now) {
    met_ = true;
    if (state.answered_() != answered_ || state.answer_() != answer_) {
      answered_ = state.answered_();
      answer_ = state.answer_();
      write("answered {:.3f} {}|{}", time(now), answered_, answer_);
    }
    const std::string question = question_of(state);
    std::string line =
        fmt::format("{} {}|{}|{}|{}", question.empty() ? 0 : 1, state.paused_() ? 1 : 0,
                    state.state_(), question, state.detail_());
    const bool news = question != question_ || state.state_() != state_;
    if (question != question_ && !question_.empty()) before_ = question_;
    question_ = question;
    state_ = state.state_();
    paused_ = state.paused_();
    if (line != line_) write("task {:.3f} {}", time(now), line);
    line_ = std::move(line);
    if (news && happens(0.4)) talk(now);
  }

  void see(const msg::MotionStatus& status, Time now) {
    const std::pair<std::uint64_t, int> told{status.goal_id_(), status.state_()};
    // A goal that is refused because of a stop before it does not say that the arm is stopped now.
    const bool stopped = status.stage_() == kStopStage && (stopped_ || told == told_);
    if (stopped != stopped_) write("stopped {:.3f} {}", time(now), stopped ? 1 : 0);
    stopped_ = stopped;
    if (told == told_) return;
    told_ = told;
    write("motion {:.3f} {} {}", time(now), told.first, told.second);
    if (happens(0.3)) talk(now);
  }

  void write_arm(Time now) {
    if (!ports_.measured_js.latest() || now - written_ < kRow) return;
    const std::string at =
        fmt::format("{:.9g}", fmt::join(ports_.measured_js.latest()->position_(), " "));
    if (at == at_) return;
    at_ = at;
    written_ = now;
    write("arm {:.3f} {}", time(now), at);
  }

  void write_goal(const msg::MotionGoal& goal, Time now) {
    for (const msg::ToolPose& through : goal.through_()) write_pose(goal, through, now);
    write_pose(goal, goal, now);
  }

  void write_pose(const msg::MotionGoal& goal, const auto& pose, Time now) {
    const auto &p = pose.position_(), &f = goal.focus_();
    const auto& q = pose.orientation_();
    write(
        "goal {:.3f} {} {} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {} {:.9g} {:.9g} "
        "{:.9g}",
        time(now), goal.goal_id_(), goal.mode_(), p.x_(), p.y_(), p.z_(), q.x_(), q.y_(), q.z_(),
        q.w_(), goal.has_focus_() ? 1 : 0, f.x_(), f.y_(), f.z_());
  }

  double time(Time now) const { return to_seconds(now - *start_); }
  template <class... Values>
  void write(fmt::format_string<Values...> format, Values&&... values) {
    chronicle_ << fmt::format(format, std::forward<Values>(values)...) << '\n';
  }

  Parameters parameters_;
  Ports ports_;
  Chance chance_, misfortune_;
  std::ofstream chronicle_;
  std::optional<Time> start_;
  bool waits_for_a_question_ = false;
  std::optional<std::uint64_t> abort_;  // behind so many words
  std::uint64_t said_ = 0;
  std::uint64_t last_id_ = 0;
  std::vector<Planned> planned_;
  // What the task told last.
  bool met_ = false, paused_ = false;
  std::string state_, question_, line_, answer_;
  std::uint64_t answered_ = 0;
  std::string before_;  // the question before
  Time waits_since_;
  std::pair<std::uint64_t, int> told_{0, -1};
  bool stopped_ = false;  // the arm, as motion told last
  bool rearms_ = false;   // once, behind a mishap
  std::optional<Mishap> mishap_;
  std::uint64_t mishaps_ = 0;
  Time hold_at_, mishap_over_, rearm_at_;
  std::string at_;  // where the arm was written to be
  Time written_;
};

}  // namespace armature::test::any_operator

ARMATURE_PLUGIN(armature::test::any_operator::AnyOperator);
