// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "picture_source.hpp"

namespace armature::pictures {

struct FilePair {
  std::filesystem::path left, right;
  Time at;
};

/// Pairs of picture files by their names.
class FolderPictures final : public PictureSource {
 public:
  struct Options {
    std::filesystem::path left, right;  // folders
    std::filesystem::path timestamps;   // empty: `interval` counts
    Duration interval{0};               // from pair to pair, without timestamps
    bool skip = false;                  // leave out files that have no partner
  };

  /// Looks at the names of files, and reads no picture. Two files are a pair when their names are
  /// the same behind the words `left` and `right`, with which names may begin and in one common
  /// folder must. Pairs are ordered by name, numbers in names by their value. Throws SetupError
  /// with the file (and line) that is wrong.
  explicit FolderPictures(const Options& options);

  std::optional<TimedPicture> next() override;
  void rewind() override { next_ = 0; }
  Duration last_interval() const override;
  std::string remark() const override { return remark_; }
  std::size_t left_out() const override { return left_out_; }

  const std::vector<FilePair>& files() const { return pairs_; }

 private:
  void find_pairs(const Options& options);
  void read_times(const std::filesystem::path& file);

  std::vector<FilePair> pairs_;
  Duration interval_;
  std::string remark_;
  std::size_t left_out_ = 0;
  std::size_t next_ = 0;  // counts pictures
};

}  // namespace armature::pictures
