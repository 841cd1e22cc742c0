// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "armature/runtime/component/component.hpp"
#include "armature/runtime/deployment/deployment.hpp"
#include "armature/runtime/reporting/run_timing.hpp"

namespace armature ARMATURE_EXPORT {

/// The outcome of a run: what its components measured, held against the deployment's goals.
class RunReport final : public Summary {
 public:
  struct Figure {
    std::string key, title;  // "left_camera.pictures" where several components tell the same
    std::variant<double, std::vector<double>, std::string> value;
    std::string unmeasured = {};    // why the value is none, or ""
    std::string inapplicable = {};  // the same, where there is nothing to be measured
    const Goal* goal = nullptr;     // of a metric that the deployment set a limit for
    bool met = true;
    std::string component = {}, metric = {};  // of the key
  };

  /// What ended the run from outside of the deployment's components.
  struct Ending {
    std::vector<std::string> faults;       // of other processes: ended before, fell silent
    std::vector<std::string> unwell = {};  // components of other processes, as Deployment::unwell
    /// Status and reason that a component of another process gave for the scenario's failure.
    std::optional<std::pair<std::string, std::string>> failed = {};
    std::optional<std::string> stopped;  // "interrupted": by the operator
    std::optional<RunTiming> timing;     // of all processes, where it shall be told
  };

  /// Asks every component of a deployment that has stopped.
  RunReport(const Deployment& deployment, const Ending& ending);

  void metric(std::string key, std::string title, double value) override;
  void series(std::string key, std::string title, std::vector<double> values) override;
  void text(std::string key, std::string title, std::string value) override;
  void not_measured(std::string key, std::string title, std::string why) override;
  void does_not_apply(std::string key, std::string title, std::string why) override;
  void failed(std::string status, std::string reason) override;

  /// "ok", "goals_missed", "fault", what a component gave for the scenario's failure
  /// ("face_not_found"), or "degraded": the deployment has no goals, and components were unwell
  /// when it was stopped.
  const std::string& status() const { return status_; }
  /// Why the scenario did not come to its end, as the component says that followed it, or "".
  const std::string& story_reason() const { return story_reason_; }
  /// What else is not ok: a line per goal, fault or lost process.
  const std::vector<std::string>& reasons() const { return reasons_; }
  /// Who was degraded or stalled when the run began to stop, and why, whatever its status.
  const std::vector<std::string>& unwell() const { return unwell_; }
  /// What ended a run that no component said was over: "the time limit of 3 s is over",
  /// "interrupted"; or "". Whether it had more to do is not known.
  const std::string& ended_by() const { return ended_by_; }
  const std::vector<Figure>& figures() const { return figures_; }
  /// Nothing unless it was asked for: these figures differ from run to run, also in lockstep.
  const std::optional<RunTiming>& timing() const { return timing_; }

 private:
  /// The metric as the plugin declares it, or nullptr.
  const MetricSpec* expect_declared(const std::string& key);
  void add_defect(const std::string& key, const std::string& what);
  void tell_apart();
  void judge_goal(const Goal& goal);
  void judge(const Deployment& deployment, const Ending& ending);

  const ComponentConfig* speaker_ = nullptr;  // the component that is being asked
  std::vector<std::string> defects_;          // of plugins that report what they must not
  std::vector<Figure> figures_;
  std::string story_status_, story_reason_, ended_by_;
  std::string status_ = "ok";
  std::vector<std::string> reasons_, unwell_;
  std::optional<RunTiming> timing_;
};

/// One JSON object: `status` first, `reason` when that is not ok, figures in order, why any of them
/// is null under `not_measured` or `does_not_apply`, `reasons`, `unwell`, and `ended_by`; numbers
/// as the shortest text that reads back the same.
std::string to_json(const RunReport& report);
/// One JSON object with what the closing table says, so that a page can show it again: `status`,
/// `reasons`, `figures` in order, each with `key`, `title`, `value`, and where there are such
/// `goal`, `met`, `not_measured` and `does_not_apply`; and `timing`.
std::string figures_json(const RunReport& report, const RunTiming& timing);
using Mark = std::function<std::string(std::string_view word, bool good)>;
using Quote = std::function<std::string(std::string_view text)>;
/// The closing table for people. `mark` gets the words that judge, "met" or "MISSED" of a goal and
/// the status, and whether they are good news; `quote` gets what plugins wrote, reasons and names.
/// Their answers stand in the place of both.
std::string to_table(const RunReport& report, const Mark& mark, const Quote& quote);
/// Lets every component of this process write its files. Empty, or who could not write what.
std::string write_component_files(const Deployment& deployment,
                                  const std::filesystem::path& directory);
/// Writes report.json and lets every component write its files beside it. Throws
/// std::runtime_error that names each file that could not be written, and why; the others are
/// there.
void write_report(const RunReport& report, const Deployment& deployment,
                  const std::filesystem::path& directory);

}  // namespace armature
