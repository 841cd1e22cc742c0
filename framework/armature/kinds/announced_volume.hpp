// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "armature/kinds/volume_messages.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/runtime/component/ports.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// The volume that a topic announces, for who needs its voxels.
class AnnouncedVolume {
 public:
  explicit AnnouncedVolume(Input<msg::VolumeFile> files) : files_{files} {}

  /// When the volume that was announced last was taken; nothing before there is one. What is found
  /// in a volume is told under its stamp.
  std::optional<Time> stamp() const {
    const msg::VolumeFile* file = files_.latest();
    return file ? std::optional{stamp_of(file->header_().stamp_())} : std::nullopt;
  }

  /// Once for every volume that is announced: the volume, or why it cannot be had. Reads files, and
  /// takes some tenths of a second.
  std::optional<Expected<Volume>> take() {
    const msg::VolumeFile* file = files_.latest();
    if (!file || (taken_ && file->sha256_() == *taken_)) return std::nullopt;
    taken_ = file->sha256_();
    return volume_of(*file);
  }

 private:
  std::optional<std::string> taken_;
  Input<msg::VolumeFile> files_;
};

}  // namespace armature
