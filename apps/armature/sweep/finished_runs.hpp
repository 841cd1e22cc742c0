// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace armature::sweep {

/// One run of a sweep, and what makes it another one than the rest.
struct RunKey {
  std::string fingerprint;  // of the files with this variation, whatever the seed, of the data and
                            // the build
  std::uint64_t seed = 0;
  auto operator<=>(const RunKey&) const = default;
};

/// The status of a run whose process ended without a report, or was not done in time.
inline constexpr const char *kCrashed = "crashed", *kTimedOut = "timed_out";

/// What runs have told, kept in a file with a line for each, so that a sweep that was interrupted
/// goes on where it stopped.
class FinishedRuns {
 public:
  /// Reads `file`, if it is there; its last line may have been cut off. Without a file nothing is
  /// kept. Throws std::runtime_error when it cannot be read, is of something else, or another sweep
  /// uses it.
  explicit FinishedRuns(std::optional<std::filesystem::path> file);
  ~FinishedRuns();
  FinishedRuns(const FinishedRuns&) = delete;
  FinishedRuns& operator=(const FinishedRuns&) = delete;

  /// The report of a run, or nullptr.
  const nlohmann::ordered_json* find(const RunKey& key) const;
  /// A run that crashed or hung is not kept in the file: a sweep that goes on tries it again.
  /// Throws std::runtime_error when the file cannot be written.
  void add(const RunKey& key, nlohmann::ordered_json report);

 private:
  void read();

  int descriptor_ = -1;  // locked against another sweep
  std::optional<std::filesystem::path> file_;
  std::map<RunKey, nlohmann::ordered_json> reports_;
};

}  // namespace armature::sweep
