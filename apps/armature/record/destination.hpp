// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "armature/runtime/reporting/draft.hpp"
#include "record/record.hpp"

namespace armature {

/// Where a recording goes: into its file, or, where that has something in it, into a draft beside
/// it that takes its place once the recording is whole. What was neither taken nor dropped stays,
/// as what died with its program does.
class Destination {
 public:
  /// Throws InvalidChoice for a file that has something in it, unless it may be replaced, and
  /// std::runtime_error while another program writes it.
  Destination(std::filesystem::path file, bool force);
  ~Destination();
  Destination(const Destination&) = delete;
  Destination& operator=(const Destination&) = delete;

  /// The file to write.
  const std::filesystem::path& path() const { return draft_ ? draft_->path() : file_; }
  bool is_draft() const { return draft_.has_value(); }
  /// Whether there was a file before, if only an empty one.
  bool was_there() const { return was_there_; }
  /// Gives the draft its name. Throws std::filesystem::filesystem_error, and the draft stays.
  void take();
  /// Takes away what was written, and leaves the file as it was.
  void drop();

 private:
  std::filesystem::path file_;
  bool was_there_;
  HeldFile older_;
  std::optional<Draft> draft_;
};

}  // namespace armature
