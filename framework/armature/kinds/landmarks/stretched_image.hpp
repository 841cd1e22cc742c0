// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "armature/kinds/image_view.hpp"

namespace armature ARMATURE_EXPORT {

/// The image, or where its brightest part (99.5 %) is darker than `below` one in `pixels`, in which
/// the grey values between the 0.5 and 99.5 percentiles fill 0 to 255: detectors and landmark
/// finders were trained on pictures of normal light. Allocates when `pixels` is too small.
ImageView stretched_if_dark(const ImageView& image, double below,
                            std::vector<std::uint8_t>& pixels);

}  // namespace armature
