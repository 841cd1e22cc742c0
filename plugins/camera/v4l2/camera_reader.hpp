// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "armature/runtime/component/driver_thread.hpp"
#include "video_stream.hpp"

namespace armature::camera::v4l2 {

/// What the thread that waits for the camera tells the component: a picture, or what is wrong.
struct Report {
  std::vector<std::uint8_t> pixels;  // mono8; empty: none
  std::string trouble;               // empty: none
  bool was_bad = false;              // a picture that could not be used
  bool has_started = false;          // the camera runs, from here on
  std::uint32_t lost_before = 0;     // pictures that the kernel has dropped
};

/// Keeps a camera running: opens it, reads its pictures, and begins again, as often as it takes,
/// when it stops, is unplugged or says nothing.
class CameraReader {
 public:
  struct Timing {
    Duration delay{0};              // from the middle of an exposure to the kernel's time of it
    Duration timeout = seconds(1);  // without a picture
    Duration first_within = seconds(5);  // of a start, which takes many cameras longer
    Duration try_again = seconds(0.5);   // after a camera could not be opened
  };

  CameraReader(std::unique_ptr<VideoDevice> device, StreamSettings settings, Timing timing)
      : device_{std::move(device)}, settings_{std::move(settings)}, timing_{timing} {}

  /// On the driver thread, until the run ends. A stamp is the middle of the exposure on the
  /// deployment's clock: the kernel's time, or, where it says none that is at most 10 s old, when
  /// the picture came; less the delay.
  void run(DriverQueue<Report>& reports);

 private:
  /// While it runs; why it does no more, empty when the run ends.
  std::string read_pictures(VideoStream& stream, DriverQueue<Report>& reports);
  Expected<void> hand_over(VideoStream& stream, const VideoStream::Frame& frame,
                           DriverQueue<Report>& reports);
  Time stamp_of(const VideoStream::Frame& frame, const DriverQueue<Report>& reports) const;

  std::unique_ptr<VideoDevice> device_;
  StreamSettings settings_;
  Timing timing_;
  jpeg::JpegDecoder decoder_;
  std::optional<std::uint32_t> last_sequence_;
};

}  // namespace armature::camera::v4l2
