// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "replay/compared_side.hpp"
#include "replay/field_differences.hpp"
#include "replay/repetition.hpp"
#include "replay/replay.hpp"

namespace armature {

/// The first call that failed with another text than in the recording, or on one side only.
struct OtherFailure {
  double at_s = 0;
  std::string recorded, now;  // empty: it did not fail
};

/// The differences of one component.
struct ComparedComponent {
  std::map<std::string, TopicDifferences> topics;
  std::optional<OtherFailure> failure;
  std::optional<double> slowest_at_s;
  Duration slowest{0};
};

/// The components of a recorded process that assignments change, as they were recorded and as they
/// are now.
class Comparison {
 public:
  /// Throws what ReplayedProcess and check_processor() throw. `plugins` outlives it.
  Comparison(const std::filesystem::path& file, const std::string& process,
             const ReplayOptions& options, PluginRegistry& plugins);

  /// Repeats all that was recorded of them. Throws std::runtime_error.
  void run();

  const std::string& process() const { return run_.process(); }
  /// Damage and gaps of the recording, one line each.
  std::vector<std::string> problems() const { return run_.problems(); }
  /// Notes on both runs, the recorded one and the one with other settings, each once.
  std::set<std::string> notes() const;
  /// Whether all that can be repeated was repeated, and held to the recording, and something was.
  bool is_complete() const;
  /// Whether all that is called recorded is what was recorded.
  bool repeats() const;
  /// Takes the name of one of components().
  const Repetition& repetition(const std::string& component) const {
    return repetitions_.at(component);
  }

  const std::vector<std::string>& changed() const { return changed_; }
  const std::map<std::string, ComparedComponent>& components() const { return components_; }
  const ComparedSide& before() const { return before_; }
  const ComparedSide& now() const { return now_; }

 private:
  void repeat(const msg::Activation& call, double at_s);

  RecordedRun run_;
  std::vector<std::string> changed_;
  ComparedSide before_, now_;
  std::map<std::string, ComparedComponent> components_;
  std::map<std::string, Repetition> repetitions_;  // of those of the recorded side
  bool now_first_ = false;
};

}  // namespace armature
