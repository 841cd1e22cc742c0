// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

class Setup;
class Summary;
class StatusReporter;

/// A running unit. Its constructor reads parameters and claims its ports and slots from `Setup`
/// (and throws SetupError with a way out when it cannot work); after that the runtime calls `step`,
/// never two at a time. Everything it does is a function of its inputs, its state and `now`.
class Component {
 public:
  static constexpr std::string_view kKind = "component";
  using Factory = std::unique_ptr<Component> (*)(Setup&);

  explicit Component(Setup& setup);
  virtual ~Component() = default;
  Component(const Component&) = delete;
  Component& operator=(const Component&) = delete;

  /// One activation, on the executor's thread: a trigger input is fresh, or the period elapsed.
  /// `now` is the only time it may use. Must not block. An exception is a fault: the component is
  /// not called again and the run ends with status "fault".
  virtual void step(Time now) = 0;

  /// Once, on the executor's thread between two steps, when the run is stopping: an operator's
  /// signal, the end of the scenario, a fault, a lost process. What moves comes to rest from here
  /// on, within its limits, and nothing is begun any more; `step` is called as before meanwhile.
  /// The same rules as for `step`: it must not block, and an exception is a fault. `now` is the
  /// deployment's clock. The default does nothing.
  virtual void begin_stop(Time now) { static_cast<void>(now); }
  /// True when what this component moves is at rest, so that the run may end. Asked after
  /// `begin_stop` and after every step from then on, on the executor's thread; the last answer
  /// counts, and a run waits for it for at most `run: {stop_within_s}`. Real-time safe. The default
  /// is for a component that moves nothing.
  virtual bool stopped() const { return true; }

  /// Once, after the last step, on the thread that stops the deployment.
  virtual void stop(Time now) { static_cast<void>(now); }

  /// What can be said of the deployment before it runs, a line each: "the search sees 87 % of the
  /// mouths". `armature check` asks and prints them behind the component's name; a run does not
  /// ask. Together they take at most 0.2 s.
  virtual std::vector<std::string> notes_for_check() const { return {}; }
  /// True when the scenario this component watches has been told; the run then stops. Asked after
  /// every step; once it is true there is no further step, so its figures stay what they are.
  virtual bool finished() const { return false; }
  /// Adds figures to the run's summary, after the last step.
  virtual void summarize(Summary& summary) const { static_cast<void>(summary); }
  /// Writes files for `armature run --report DIR`, after the last step.
  virtual void write_files(const std::filesystem::path& directory) const {
    static_cast<void>(directory);
  }

 protected:
  /// A line for the operator ("searching 4/9"); printed when it differs from the one before. All
  /// three are real-time safe; very long text is cut.
  void log(std::string_view text);
  /// Published as the component's state until `healthy` is called: what is missing and why. It is
  /// printed, too, but not while the run is stopping and the component rests: what it hears from
  /// ends then.
  void degraded(std::string_view reason);
  void healthy();

 private:
  std::shared_ptr<StatusReporter> reporter_;
};

/// The figures of a run, in order: what the closing table and `--json` show, and what `goals:`
/// refer to.
class Summary {
 public:
  virtual ~Summary() = default;
  /// `key` ends in its unit ("distance_error_mm"); `title` is for the table.
  virtual void metric(std::string key, std::string title, double value) = 0;
  /// The same of several, such as every site: an array in JSON.
  virtual void series(std::string key, std::string title, std::vector<double> values) = 0;
  virtual void text(std::string key, std::string title, std::string value) = 0;
  /// That a metric cannot be told, and why: "the hand does not tremble". A goal on it is not met.
  virtual void not_measured(std::string key, std::string title, std::string why) = 0;
  /// That there is nothing in this run that a metric could be of, and why: "the drill does not
  /// turn". A goal on it decides nothing. What is there and could not be seen is `not_measured`.
  virtual void does_not_apply(std::string key, std::string title, std::string why) = 0;
  /// Why the scenario did not come to its end: its status ("refused"), which overrides ok and
  /// goals_missed, and the reason for people ("the jaw has moved by 2 mm").
  virtual void failed(std::string status, std::string reason) = 0;
};

}  // namespace armature
