// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "armature/kinds/image_view.hpp"

namespace armature ARMATURE_EXPORT {

/// Sees cameras whose driver gives its last picture again with a new stamp, by a thinned copy of
/// the picture before: 0 of its pixels differ.
///
/// That alone proves nothing: the picture of a still scene without noise is the same, too. It is a
/// fault where the other camera's picture changed meanwhile, in an eighth of its pixels or more; or
/// where the camera has shown noise, which no still scene takes away. Noise is what changed a third
/// of the pixels or more in twelve of sixteen parts of the picture, three pairs in a row: a thing
/// that moves before a wall does not.
class FrozenCameras {
 public:
  struct Frozen {
    std::string why;  // for people, with a way out
    int repeats;      // how often the picture has come again
  };
  /// The next pair, with a later stamp than the one before. Tells a pair that is none of one
  /// instant, from the first repeat on; nothing otherwise. Allocates.
  std::optional<Frozen> look_at(const ImageView& left, const ImageView& right);

 private:
  struct Change {
    double share = 1;       // of the thinned pixels
    bool is_noise = false;  // in most parts of the picture
  };
  struct Camera {
    /// What changed since the last picture; all of the first one.
    Change change(const ImageView& picture);

    std::vector<std::uint8_t> thinned;
    int width = 0, height = 0;  // of the picture [px]
    int noisy_pairs = 0;        // in a row
    int repeats = 0;            // how often the same picture has come again
  };

  std::array<Camera, 2> cameras_;
};

}  // namespace armature
