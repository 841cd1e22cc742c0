// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace armature {

/// The list of the files that a run has written into the folder of its report, `report.sha256`, as
/// sha256sum writes and checks it. By it the next run into the same folder knows what is older, so
/// that nobody takes a picture of yesterday for one of today.
class ReportList {
 public:
  explicit ReportList(std::filesystem::path folder) : folder_{std::move(folder)} {}

  /// Runs `write`, and adds the files that came or changed meanwhile, also when it throws.
  void add_what(const std::function<void()>& write);
  /// A file of the folder, if it is there when the list is written.
  void add(const std::string& name) { names_.insert(name); }
  const std::set<std::string>& names() const { return names_; }
  /// Throws std::runtime_error with the reason.
  void write() const;

 private:
  struct File {
    std::uintmax_t number = 0, size = 0;  // its inode
    std::int64_t changed_ns = 0;
    bool operator==(const File&) const = default;
  };
  std::map<std::string, File> files() const;

  std::filesystem::path folder_;
  std::set<std::string> names_;
};

/// Removes the files that an older run has listed, and its list. What is no longer as that run left
/// it stays, and so does all that it did not write; returned are the names of those that changed.
std::vector<std::string> remove_listed_files(const std::filesystem::path& folder);

}  // namespace armature
