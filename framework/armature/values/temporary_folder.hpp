// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace armature {

/// A folder that is gone with what is in it at the end.
class TemporaryFolder {
 public:
  /// Throws std::system_error when none can be made.
  TemporaryFolder() {
    std::string name = std::filesystem::temp_directory_path() / "armature-XXXXXX";
    if (!mkdtemp(name.data())) {
      throw std::system_error{errno, std::generic_category(), "cannot make " + name};
    }
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::filesystem::path& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace armature
