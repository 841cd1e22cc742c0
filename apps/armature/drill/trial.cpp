// SPDX-License-Identifier: Apache-2.0
#include "drill/trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "drill/arm_listener.hpp"
#include "drill/run_under_test.hpp"
#include "drill/verdict.hpp"

namespace armature::drill {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kLook{2};
constexpr const char* kScenarioOver = "stopping: the scenario is over";
constexpr milliseconds kStartWithin{60000};
constexpr milliseconds kMoveWithin{60000};
constexpr milliseconds kNextPress{250};
constexpr milliseconds kMoveAgainWithin{1000};
constexpr milliseconds kShownWithin{8000};
/// A movement is none to go on with as long after a fault: an arm may ramp down.
constexpr milliseconds kRampsFor{1000};
/// Within which time after that a run that is to go on has moved again.
constexpr milliseconds kGoesOnWithin{9000};
/// How long arms are watched that are to stay where they are.
constexpr milliseconds kHoldsFor{2500};

std::vector<std::string> arguments_of(const TrialOptions& options, const Fault& fault, Form form,
                                      const Pendant* pendant) {
  std::vector<std::string> words{"run"};
  for (const auto& file : options.source.files) words.push_back(file.string());
  const auto set = [&](const std::string& setting) {
    words.insert(words.end(), {"--set", setting});
  };
  for (const std::string& setting : options.source.assignments) set(setting);
  set("clock=system");
  set("dds={}");                // the arms of other machines are not drilled
  set("run.time_limit_s=120");  // whatever happens
  if (options.deployment.records) set("record=null");
  if (form == Form::split) {
    for (const std::string& setting : options.deployment.apart) set(setting);
  }
  if (pendant) {
    for (const std::string& setting : pendant->settings()) set(setting);
  }
  if (fault.outcome == Outcome::holds) {
    for (const std::string& setting : options.deployment.unreported) set(setting);
  }
  words.insert(words.end(), {"--domain", std::to_string(options.domain), "--json", "--timing"});
  if (!fault.inject.empty()) words.insert(words.end(), {"--inject", fault.inject});
  return words;
}

bool wait_for(milliseconds timeout, const std::function<bool()>& condition) {
  for (const auto end = steady_clock::now() + timeout; !condition();) {
    if (steady_clock::now() > end) return false;
    std::this_thread::sleep_for(kLook);
  }
  return true;
}

class Trial {
 public:
  Trial(const TrialOptions& options, const Fault& fault, Form form)
      : options_{options},
        fault_{fault},
        pendant_{fault.has_pendant ? std::make_unique<Pendant>(options.deployment.heed_pendants)
                                   : nullptr},
        arguments_{arguments_of(options, fault, form, pendant_.get())},
        listener_{options.plugins, options.deployment, options.domain},
        power_{fault.has_power_switch
                   ? std::make_unique<PowerSwitch>(options.plugins, options.deployment.arms,
                                                   options.domain)
                   : nullptr},
        run_{arguments_, options.stop} {}

  TrialResult run(Form form, double moment_s) {
    result_ = {.fault = fault_.name, .form = form, .moment_s = moment_s};
    if (reach_moment() && fire() && end()) judge_arms();
    if (options_.stop.stop_requested()) run_.ends_within(end_timeout());
    return result_;
  }

 private:
  /// False, with what was wrong, when the arm never moved.
  bool reach_moment() {
    const auto start = steady_clock::now();
    const auto starts = [&] { return run_.runs() && steady_clock::now() - start < kStartWithin; };
    if (!listener_.find_arms(starts)) return fail("it did not start: " + run_.last_line());
    if (pendant_) pendant_->hold(true);
    if (!wait_for(kMoveWithin, [&] { return !run_.runs() || moves_when_rearmed(); }) ||
        !run_.runs()) {
      return fail("no arm moved: " + run_.last_line());
    }
    const std::ptrdiff_t stops = count_stops();
    run_.find_processes();
    wait_for(
        std::chrono::duration_cast<milliseconds>(std::chrono::duration<double>{result_.moment_s}),
        [&] { return !run_.runs(); });
    wait_for(kMoveAgainWithin, [&] { return !run_.runs() || listener_.any_moves(); });
    if (!run_.runs()) return fail("it had ended before the fault: " + how_it_ended());
    return count_stops() == stops || fail("it had stopped before the fault: " + run_.last_line());
  }

  /// Counts the stops so far of all components that heed the operator's pendant.
  std::ptrdiff_t count_stops() const {
    std::ptrdiff_t stops = 0;
    for (const HeedsPendant& component : options_.deployment.heed_pendants) {
      stops += run_.count_lines(component.name, "stopped until it is rearmed");
    }
    return stops;
  }

  /// An operator presses until something moves: arms with a pendant begin stopped.
  bool moves_when_rearmed() {
    if (listener_.any_moves()) return true;
    if (pendant_ && steady_clock::now() > next_press_) {
      pendant_->rearm();
      next_press_ = steady_clock::now() + kNextPress;
    }
    return false;
  }

  bool fire() {
    stop_at_ = steady_clock::now();
    Scene scene{.run = run_,
                .listener = listener_,
                .deployment = options_.deployment,
                .plugins = options_.plugins,
                .domain = options_.domain,
                .pendant = pendant_.get(),
                .power = power_.get(),
                .fired_at = stop_at_,
                .held_from = held_from_,
                .arguments = arguments_,
                .stop = options_.stop};
    const std::vector<bool> moved = listener_.moving();
    if (const std::string wrong = fault_.fire(scene); !wrong.empty()) return fail(wrong);
    switch (fault_.outcome) {
      case Outcome::stops: return true;
      case Outcome::goes_on: return go_on(moved);
      case Outcome::holds: return hold();
    }
    return true;
  }

  /// Watches a run until it has gone on, then interrupts it.
  bool go_on(const std::vector<bool>& moved) {
    const Arrival from = steady_clock::now() + kRampsFor;
    const bool went = wait_for(kRampsFor + kGoesOnWithin, [&] {
      return !run_.runs() || went_on(moved, listener_.went_on_after(from));
    });
    find_shown();
    if (run_.line_with(kScenarioOver)) return end_story();
    if (!still_runs()) return false;
    if (!went) {
      const double watched_s = to_seconds(kRampsFor + kGoesOnWithin);
      return fail(fmt::format(
          "{} within {:g} s",
          stood_still(options_.deployment.arms, moved, listener_.went_on_after(from)), watched_s));
    }
    stop_at_ = steady_clock::now();
    run_.signal(SIGINT);
    return true;
  }

  /// A run may come to the end of its scenario after a fault; one whose task gave up has not, and
  /// passes where the fault leaves a task no choice.
  bool end_story() {
    stop_at_ = steady_clock::now();
    const std::string how = how_it_ended();
    const auto told = closing();
    if (!told.contains("status")) return fail("the run ended: " + how);
    const auto reasons = told.value("reasons", nlohmann::json::array());
    // The scenario's own reason is in `reason` only; a fault's stands in `reasons`, too.
    const bool gave_up =
        told.contains("reason") && std::ranges::find(reasons, told["reason"]) == reasons.end();
    if (gave_up && !fault_.may_give_up) return fail("the run ended: " + how);
    scenario_end_ = gave_up ? "its task gave up: " + how : "went on to the end of its scenario";
    return true;
  }

  /// Watches arms that are to stay where they are, then interrupts the run.
  bool hold() {
    if (!held_from_) {
      listener_.wait_for_rest();
      held_from_ = steady_clock::now();
    }
    wait_for(kHoldsFor, [&] { return !run_.runs(); });
    find_shown();
    if (run_.line_with(kScenarioOver)) {
      result_.untried = "the task gave up";
      return true;
    }
    if (!still_runs()) return false;
    run_.signal(SIGINT);
    return true;
  }

  /// False, with how it ended, when the run has ended or is about to.
  bool still_runs() {
    if (const auto ended = run_.line_with("stopping:")) return fail("the run ended: " + *ended);
    return run_.runs() || fail("the run ended: " + how_it_ended());
  }

  void find_shown() {
    if (fault_.shown.empty()) return;
    result_.shown = run_.wait_for_line(fault_.shown, kShownWithin).value_or("");
  }

  milliseconds end_timeout() const {
    // Beside coming to rest: steps that hang are waited for, and so are processes that do not end.
    return milliseconds{static_cast<int>(1000 * options_.deployment.stop_within_s) + 10000};
  }

  bool end() {
    const milliseconds timeout = end_timeout();
    if (!run_.ends_within(timeout)) {
      return fail(fmt::format("it had not ended after {} s", timeout.count() / 1000));
    }
    find_shown();
    if (!fault_.shown.empty() && result_.shown.empty()) {
      return fail(fmt::format("it did not say '{}'", fault_.shown));
    }
    return true;
  }

  void judge_arms() {
    listener_.hear_out();
    const auto hand = held_from_ ? listener_.hand_moved_after(*held_from_) : std::nullopt;
    const Verdict verdict =
        judge(options_.deployment.arms, listener_.records(),
              {.stop = stop_at_, .held_from = held_from_, .held_until = hand, .lost = fault_.lost});
    result_.wrong = verdict.wrong;
    result_.step_s = commanders_step_s();
    result_.rest_s = verdict.rest_s;
    const bool holds = fault_.outcome == Outcome::holds;
    const double allowed_s = holds ? to_seconds(kHoldsFor) : options_.deployment.stop_within_s;
    if (!result_.failed() && verdict.rest_s > allowed_s) {
      fail(fmt::format("it moved for {:.2f} s more, and {:g} s are allowed", verdict.rest_s,
                       allowed_s));
      return;
    }
    result_.arm = verdict.arm;
    if (!verdict.wrong.empty()) return;
    if (!scenario_end_.empty()) {
      result_.arm = scenario_end_;
    } else if (fault_.outcome == Outcome::goes_on) {
      result_.arm = "went on, then " + verdict.arm;
    }
    if (holds) result_.arm += " and stayed there";
    if (hand) {
      result_.arm +=
          fmt::format(" until a hand went on {:.2f} s later", to_seconds(*hand - *held_from_));
    }
  }

  /// What the run told at its end; no object when it was killed.
  nlohmann::json closing() const { return nlohmann::json::parse(run_.output(), nullptr, false); }

  std::string how_it_ended() {
    run_.ends_within(kShownWithin);
    const auto told = closing();
    if (!told.contains("status")) return run_.last_line();
    const std::string reason = told.value("reason", "");
    return fmt::format("status {}{}{}", told.value("status", ""), reason.empty() ? "" : ": ",
                       reason);
  }

  /// Nothing when the run was killed.
  std::optional<double> commanders_step_s() const {
    const auto told = closing();
    std::optional<double> longest;
    for (const std::string& name : options_.deployment.commanders) {
      const nlohmann::json::json_pointer p999{"/timing/components/" + name + "/processor/p999_s"};
      if (told.contains(p999)) longest = std::max(longest.value_or(0), told[p999].get<double>());
    }
    return longest;
  }

  bool fail(std::string wrong) {
    result_.wrong = std::move(wrong);
    result_.arm = result_.wrong;
    return false;
  }

  const TrialOptions& options_;
  const Fault& fault_;
  std::unique_ptr<Pendant> pendant_;
  std::vector<std::string> arguments_;
  ArmListener listener_;
  std::unique_ptr<PowerSwitch> power_;
  RunUnderTest run_;
  TrialResult result_{};
  Arrival stop_at_{}, next_press_{};
  std::optional<Arrival> held_from_;  // of arms that are to stay where they are
  std::string scenario_end_;          // of a run that was to go on, where it ended by itself
};

}  // namespace

TrialResult try_fault(const TrialOptions& options, const Fault& fault, Form form, double moment_s) {
  return Trial{options, fault, form}.run(form, moment_s);
}

}  // namespace armature::drill
