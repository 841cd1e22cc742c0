// SPDX-License-Identifier: Apache-2.0
#include "png_encoder.hpp"

#include <png.h>

#include <stdexcept>

namespace armature::png {

std::string encoded(const Pixels& pixels) {
  const bool known = pixels.channels == 1 || pixels.channels == 3;
  if (pixels.width < 1 || pixels.height < 1 || !known) {
    throw std::invalid_argument("a PNG has pixels, of 1 or 3 channels");
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(pixels.width);
  image.height = static_cast<png_uint_32>(pixels.height);
  image.format = pixels.channels == 1 ? PNG_FORMAT_GRAY : PNG_FORMAT_BGR;
  image.flags = PNG_IMAGE_FLAG_FAST;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string out(size, '\0');
  if (png_image_write_to_memory(&image, out.data(), &size, 0, pixels.data,
                                static_cast<png_int_32>(pixels.stride), nullptr) == 0) {
    throw std::runtime_error(std::string{"libpng could not write a picture: "} + image.message);
  }
  out.resize(size);
  return out;
}

}  // namespace armature::png
