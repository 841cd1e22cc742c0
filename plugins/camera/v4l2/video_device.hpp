// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "armature/values/time.hpp"

namespace armature::camera::v4l2 {

/// What a driver of cameras asks of the kernel: a file of /dev/video*, its requests and its memory.
/// Tests put a camera of their own in its place. One thread at a time; none is real-time safe.
class VideoDevice {
 public:
  enum class Wake { frame, timeout, stop };

  virtual ~VideoDevice() = default;
  /// 0, or the number of the error (errno).
  virtual int open(const std::string& path) = 0;
  /// Gives back what was mapped, too. Also when it is not open.
  virtual void close() = 0;
  /// A request of linux/videodev2.h and its structure: 0, or the number of the error.
  virtual int request(unsigned long number, void* argument) = 0;
  /// A buffer of the camera; empty when there is none. Readable until close().
  virtual std::span<const std::uint8_t> map(std::size_t length, std::int64_t offset) = 0;
  /// Waits until a picture, or an error, can be taken, `stop_descriptor` becomes readable, or
  /// `timeout` is over.
  virtual Wake wait(int stop_descriptor, Duration timeout) = 0;
  /// The clock by which the kernel tells when pictures were taken.
  virtual Duration monotonic_now() const = 0;
};

}  // namespace armature::camera::v4l2
