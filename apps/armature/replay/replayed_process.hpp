// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "replay/recorded_run.hpp"
#include "replay/replayed_component.hpp"

namespace armature {

/// The components of a recorded process, constructed anew from the recorded file, or from it with
/// `--set` assignments.
class ReplayedProcess {
 public:
  struct Entry {
    std::unique_ptr<ReplayedComponent> component;  // null: it is not replayed
    std::string why_not;                           // then
    std::uint64_t activations = 0;
    std::optional<std::string> ends;  // why it is replayed no further
  };

  /// Throws ConfigError, PluginError, or what a constructor of a component throws. `run` and
  /// `plugins` outlive it. `only`: the names of those that are constructed; empty: all.
  ReplayedProcess(RecordedRun& run, PluginRegistry& plugins,
                  const std::vector<std::string>& assignments,
                  const std::vector<std::string>& only = {});

  const DeploymentConfig& config() const { return config_; }
  std::map<std::string, Entry>& entries() { return entries_; }
  const std::map<std::string, Entry>& entries() const { return entries_; }
  /// What the operator should know: parameters that an assignment left out, plugins that are
  /// another build than the recorded one.
  const std::vector<std::string>& notes() const { return notes_; }

  /// Repeats a call `at_s` after the beginning of the recording. Null: its component is not
  /// replayed, or no further.
  Entry* repeat(const msg::Activation& call, double at_s);

 private:
  void note_other_libraries(const RecordedRun& run);
  void construct(const std::string& name, const RecordedPorts& ports, PluginRegistry& plugins);

  RecordedRun* run_;
  std::vector<std::string> notes_;
  DeploymentConfig config_;
  std::map<std::string, std::string> lost_volumes_;  // why, by the topic that announces one
  std::map<std::string, Entry> entries_;
};

/// Throws InvalidChoice when `run` was recorded on a processor of another level than this one.
void check_processor(const RecordedRun& run);

}  // namespace armature
