// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace armature::bench {

/// A folder that is gone with what is in it at the end.
class TemporaryFolder {
 public:
  /// Throws std::runtime_error when none can be made.
  TemporaryFolder() {
    std::string name = std::filesystem::temp_directory_path() / "armature-bench-XXXXXX";
    if (!mkdtemp(name.data())) throw std::runtime_error{"no temporary folder can be made"};
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace armature::bench
