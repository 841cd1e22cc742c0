// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "armature/values/expected.hpp"
#include "luma.hpp"
#include "video_device.hpp"

namespace armature::camera::v4l2 {

/// What is asked of a camera, and must be had exactly.
struct StreamSettings {
  std::string device;
  int width = 0, height = 0;     // [px]
  double rate = 0;               // [1/s]; 0: any
  std::optional<Layout> layout;  // none: the first of Layout that the camera has so
  double exposure = 0;           // [s]; 0: automatic
  std::optional<int> gain;       // in the camera's steps; none: as it is
};

/// The pictures of one camera, in buffers that the kernel fills in turn (V4L2's streaming I/O with
/// mmap). One thread; not real-time safe.
class VideoStream {
 public:
  struct Frame {
    std::span<const std::uint8_t> bytes;  // until it is given back
    bool is_damaged = false;              // as the driver says
    std::optional<Duration> at;           // by the monotonic clock; none: the driver does not say
    std::uint32_t sequence = 0;           // counts also those that the kernel has dropped
    std::uint32_t buffer = 0;
  };

  VideoStream(VideoDevice& device, StreamSettings settings)
      : device_{device}, settings_{std::move(settings)} {}
  ~VideoStream() { close(); }
  VideoStream(const VideoStream&) = delete;
  VideoStream& operator=(const VideoStream&) = delete;

  /// Opens the camera, sets it, and lets it run. Or why not: it is not there, cannot stream, or
  /// has not what is asked for, with what it has.
  Expected<void> open();
  void close();
  /// After a wait that told of a frame; nothing when there is none after all. A reason: the stream
  /// is lost, and must be opened again.
  Expected<std::optional<Frame>> take();
  Expected<void> give_back(const Frame& frame);

  Layout layout() const { return layout_; }
  std::size_t stride() const { return stride_; }

 private:
  Expected<void> check_device();
  /// The first format of Layout that the camera has at the size and rate that are asked for.
  Expected<void> set_format_and_rate();
  Expected<void> set_format(std::uint32_t pixel_format);
  Expected<void> set_rate();
  Expected<void> set_exposure_and_gain();
  Expected<void> set_control(std::uint32_t id, std::int64_t value, const std::string& parameter);
  Expected<void> map_buffers();
  std::vector<std::uint32_t> offered_formats();
  std::string offered_sizes(std::uint32_t pixel_format);

  VideoDevice& device_;
  StreamSettings settings_;
  std::string card_;
  Layout layout_ = Layout::grey;
  std::size_t stride_ = 0;
  std::vector<std::span<const std::uint8_t>> buffers_;
  bool runs_ = false;
};

}  // namespace armature::camera::v4l2
