// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string_view>

namespace armature ARMATURE_EXPORT {

/// A file that is being written beside the one that it becomes, and taken away again unless it has
/// got its name. Its own name is drawn by lot: nothing that was there, of another process or from
/// before a power cut, is in its way, and nothing is replaced but by `give_name`.
class Draft {
 public:
  /// What becomes of a link that has the name.
  enum class Link { keeps_pointing, is_replaced };
  /// "run.mcap.joining-5f31c0" for "run.mcap" and "joining". `mode`: its permissions, of which the
  /// umask takes some. Throws std::runtime_error when it cannot be made, and for a name of a device
  /// or a pipe, which must not become a file.
  Draft(std::filesystem::path named, std::string_view purpose, mode_t mode = 0600,
        Link link = Link::keeps_pointing);
  ~Draft();
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Open for writing, until it has its name.
  int descriptor() const { return descriptor_; }
  /// Replaces what has the name. Throws std::filesystem::filesystem_error when it cannot.
  void give_name();
  /// Leaves it under the name of its own: it has what is nowhere else.
  void keep();

 private:
  void close_file();

  std::filesystem::path named_, path_;
  int descriptor_ = -1;
};

}  // namespace armature
