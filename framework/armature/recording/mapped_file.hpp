// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace armature {

/// A file's bytes, read when they are looked at. A program that looks at what is no longer there,
/// because somebody made the file shorter meanwhile, ends with the file's name and exit code 1. A
/// handler for SIGBUS that the program had before runs for all else.
class MappedFile {
 public:
  /// Throws std::runtime_error for a file that cannot be read; what is no file is empty.
  explicit MappedFile(const std::filesystem::path& file);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::span<const std::byte> bytes_;
  std::size_t place_ = 0;  // among those whose end is told by name
};

}  // namespace armature
