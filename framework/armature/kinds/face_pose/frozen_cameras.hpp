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
/// fault where the camera has shown noise, which no still scene takes away; or where the other
/// camera has seen something move since: one of 200 of its pixels, by more than 12 grey values, in
/// the columns that both cameras see of what is not nearer than a face. A camera that was found
/// frozen stays so until its own picture changes, also when what moved has come to rest. Noise is
/// what changed a third of the pixels or more in twelve of sixteen parts of the picture, three
/// pairs in a row: a thing that moves before a wall does not.
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
  struct Camera {
    /// Keeps a thinned copy of the newest picture and of the one before.
    void take(const ImageView& picture);
    bool has_changed() const { return is_first || now != before; }

    std::vector<std::uint8_t> now, before;
    std::vector<std::uint8_t> other_then;  // the other camera's, when this one's changed last
    int width = 0, height = 0;             // of the picture [px]
    bool is_first = true;                  // of its size
    int noisy_pairs = 0;                   // in a row
    int repeats = 0;                       // how often the same picture has come again
    const char* proof = nullptr;           // that it is frozen
  };

  std::array<Camera, 2> cameras_;
};

}  // namespace armature
