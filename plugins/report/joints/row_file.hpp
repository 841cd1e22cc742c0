// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace armature::report::joints {

/// A file that grows by whole lines: whoever ends the program, and whatever the disk refuses, there
/// is no half line in it.
class RowFile {
 public:
  /// Makes the file anew, its owner's only (0600). What an older run left there goes first, and so
  /// does a link, which is not followed. Throws std::runtime_error with the reason.
  explicit RowFile(std::filesystem::path file);
  ~RowFile();
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;

  /// Hands whole lines to the system; nothing after the first refusal. It may wait for the disk.
  void append(std::string_view lines);
  /// Waits until the disk has all of it.
  void sync();
  /// Why nothing more is written, or "".
  const std::string& trouble() const { return trouble_; }

 private:
  void refuse(int error);

  std::filesystem::path file_;
  int descriptor_;
  std::int64_t size_ = 0;  // of what is whole
  std::string trouble_;
};

/// Removes the regular file, or the link, that lies at `file`. Throws std::runtime_error when
/// something else does, or when it cannot be removed.
void remove_older(const std::filesystem::path& file);

}  // namespace armature::report::joints
