// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "armature/messages/sensor_msgs.hpp"
#include "armature/values/expected.hpp"

namespace armature::jpeg {

/// Compresses pictures with libjpeg-turbo. One thread at a time; not real-time safe.
class JpegEncoder {
 public:
  /// `quality`: 1 to 100.
  explicit JpegEncoder(int quality);
  /// Writes `image` into `jpeg`. Refuses other encodings than mono8, rgb8, bgr8, rgba8 and bgra8, a
  /// picture without pixels, and one with fewer bytes than its size needs.
  Expected<void> encode(const msg::Image& image, std::vector<std::uint8_t>& jpeg);

 private:
  struct Close {
    void operator()(void* compressor) const;
  };
  std::unique_ptr<void, Close> compressor_;
  int quality_;
};

}  // namespace armature::jpeg
