// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "armature/values/expected.hpp"

namespace armature::jpeg {

/// Columns and rows [px].
struct Size {
  int width = 0, height = 0;
};

/// Whether bytes begin as a JPEG does.
bool is_jpeg(std::span<const std::uint8_t> bytes);

/// Unpacks pictures with libjpeg-turbo, such as a camera's motion JPEG. One thread at a time; not
/// real-time safe.
class JpegDecoder {
 public:
  JpegDecoder();
  /// The size of a picture, by its header.
  Expected<Size> size_of(std::span<const std::uint8_t> jpeg);
  /// Writes the brightness of a picture into `pixels`, `width * height` bytes. Refuses a picture of
  /// another size, and one of which bytes are missing or wrong: part of it would be grey.
  Expected<void> decode_gray(std::span<const std::uint8_t> jpeg, int width, int height,
                             std::vector<std::uint8_t>& pixels);

 private:
  struct Close {
    void operator()(void* decompressor) const;
  };
  tl::unexpected<Reason> refuse_with_reason() const;

  std::unique_ptr<void, Close> decompressor_;
};

}  // namespace armature::jpeg
