// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "armature/config/node.hpp"

namespace armature {
namespace config ARMATURE_EXPORT {

/// While one exists, all pipes that its thread reads together may be waited for for 2 s: what one
/// load asks for would otherwise take as long as it names pipes. One inside another's life changes
/// nothing.
class PipeTimeLimit {
 public:
  PipeTimeLimit();
  ~PipeTimeLimit();
  PipeTimeLimit(const PipeTimeLimit&) = delete;
  PipeTimeLimit& operator=(const PipeTimeLimit&) = delete;

 private:
  bool is_outermost_;
};

/// The bytes of a YAML file. Throws ConfigError at `asked_by` (the place of an `include:`, or
/// nothing) when it cannot be read, is a device or larger than 16 MiB, or is a pipe that is not
/// written to its end within 2 s (see PipeTimeLimit).
std::string read_source(const std::filesystem::path& file, const Origin& asked_by);

/// Text that is known to be UTF-8 without control characters, and the places in it.
class SourceText {
 public:
  /// Throws ConfigError at the first byte that is not UTF-8 or a control character. A byte order
  /// mark is dropped.
  SourceText(std::string text, std::string name);

  const std::string& text() const { return text_; }
  /// The place of a byte; its column counts characters, as editors do.
  Origin place(std::size_t byte) const;

 private:
  std::string text_;
  std::string name_;
  std::vector<std::size_t> line_starts_;
  std::vector<std::size_t> continuation_bytes_;  // those that start no character
};

}  // namespace config
}  // namespace armature
