// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/recorded_processes.hpp"
#include "picture_source.hpp"

namespace armature::camera::images {

/// The pictures of two topics of an MCAP file: sensor_msgs/Image, or sensor_msgs/CompressedImage.
/// Of a recording that was joined it plays each once, as the process that sent it has recorded it.
/// Where the file is damaged, or ends too early, it tells that in place of what is missing there.
class RecordedPictures final : public pictures::PictureSource {
 public:
  /// `left` and `right` are whole names of topics, or their last words: "left/image_raw" of
  /// "/dental_lamp/left/image_raw". Throws SetupError when the file is none, when its summary has
  /// no such topic, or several. A file without a summary is looked through by `next` alone: of
  /// several topics it plays the first, and tells the pictures of the others as damage.
  RecordedPictures(std::filesystem::path file, std::string left, std::string right);

  std::optional<pictures::TimedPicture> next() override;
  void rewind() override;
  Duration last_interval() const override { return last_interval_; }
  std::string remark() const override { return remark_; }
  bool has_more() const override { return !ended_; }

 private:
  std::optional<pictures::TimedPicture> read_next();
  pictures::TimedPicture damage(const std::string& problem);
  std::optional<pictures::Side> side_of(const McapMessage& message) const;
  pictures::TimedPicture picture_of(pictures::Side side, const McapMessage& message) const;

  std::filesystem::path file_;
  std::string left_, right_;
  std::array<std::string, 2> topics_;  // whole names, by side; "" before the first picture
  RecordedCopies copies_;
  std::unique_ptr<McapReader> reader_;
  std::optional<Time> last_left_;
  Duration last_interval_;
  std::optional<pictures::TimedPicture> next_;  // read, and what was met on the way is told first
  bool ended_ = false;
  std::size_t told_ = 0;  // of the reader's problems
  std::string error_;     // at which reading ended, not told yet
  std::string remark_;
};

}  // namespace armature::camera::images
