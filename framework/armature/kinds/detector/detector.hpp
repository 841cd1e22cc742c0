// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "armature/kinds/image_view.hpp"
#include "armature/kinds/made_for_robot.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// A face as a detector sees it. Scores of different detectors cannot be compared.
struct DetectedFace {
  PixelBox box;
  double score = 0;
};

/// Where faces are sought.
struct SearchRegion {
  PixelBox box;  // of the image; the part of it that lies outside is left out
  /// [px] about how wide the face is there, which lets a detector resample the region; nothing:
  /// faces of every size that it can find.
  std::optional<double> face_width;
};

/// Finds all faces in one image.
class FaceDetector {
 public:
  static constexpr std::string_view kKind = "detector";
  using Factory = MadeFromParams<FaceDetector>;

  virtual ~FaceDetector() = default;
  /// The faces of the region in pixels of the image, in any order; none is no failure. A reason
  /// when the image is none (`invalid_input`). Not const: a detector may keep scratch memory, never
  /// knowledge. May allocate.
  virtual Expected<std::vector<DetectedFace>> detect(const ImageView& image,
                                                     const SearchRegion& region) = 0;
};

}  // namespace armature
