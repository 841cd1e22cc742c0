// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/diagnostic_msgs.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/ports.hpp"
#include "armature/runtime/execution/component_runner.hpp"
#include "armature/runtime/plugins/plugin_manifest.hpp"

namespace armature ARMATURE_EXPORT {

/// The runtime's own component in every process: tells twice a second how each component is, as
/// armature_msgs/ComponentStates and, for ROS tools, on /diagnostics, with the times of its steps
/// and of its executor since the last time; and once what the process consists of. One that has
/// missed more periods than it kept for a second is degraded, and the operator is told. It runs on
/// an executor of its own: nobody else's step can silence it.
class StatePublisher final : public Component {
 public:
  /// `runners` outlives it and holds the components of `process`; `measuring` are the names of
  /// those whose measurements they answer to (ComponentRunner::reactions). `description` outlives
  /// it and is read in the first step.
  StatePublisher(Setup& setup, std::string process,
                 const std::vector<std::unique_ptr<ComponentRunner>>& runners,
                 std::vector<std::string> measuring, const msg::DeploymentDescription& description);

  static const PluginManifest& manifest();
  void step(Time now) override;

 private:
  /// The figures of a histogram since the last time, and what it had counted by then.
  struct Window {
    TimingHistogram::Counts before{};
    TimingFigures figures{};
    void move_on(const TimingHistogram& histogram);
  };
  /// The counts of a component at the last report, and for how many reports it has been late.
  struct Counted {
    std::uint64_t activations = 0, overruns = 0, ahead = 0;
    int late = 0;
    Window lateness, duration, processor;
    std::vector<Window> reactions;  // to each of measuring_
  };
  struct CountedExecutor {
    const std::string* name;
    Window lateness, duration;
  };
  void move_on();
  /// The status of the component, with the periods that it missed since the last report.
  StatusReporter::Status status_of(const ComponentRunner& runner, Counted& counted);
  /// The same, without its periods: an input that is stamped too far ahead is a reason.
  StatusReporter::Status status_with_stamps(const ComponentRunner& runner, Counted& counted);
  void write_state(const ComponentRunner& runner, const Counted& counted,
                   const StatusReporter::Status& status, msg::ComponentState& state) const;
  void set_reactions(const Counted& counted, std::vector<msg::ReactionTiming>& reactions) const;
  void publish_description(Time now);
  static msg::DiagnosticStatus diagnostic_of(const ComponentRunner& runner, const Counted& counted,
                                             const StatusReporter::Status& status);
  static msg::DiagnosticStatus diagnostic_of(const CountedExecutor& executor);

  std::string process_;
  const std::vector<std::unique_ptr<ComponentRunner>>& runners_;
  std::vector<std::string> measuring_;
  const msg::DeploymentDescription* to_describe_;  // null: it has described
  std::vector<Counted> counted_;                   // of runners_
  std::map<const CycleTimes*, CountedExecutor> executors_;
  Output<msg::ComponentStates> states_;
  Output<msg::DeploymentDescription> description_;
  Output<msg::DiagnosticArray> diagnostics_;
};

}  // namespace armature
