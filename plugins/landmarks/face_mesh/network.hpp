// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "armature/values/expected.hpp"

namespace armature::landmarks::face_mesh {

/// What the network sees in a picture.
struct Mesh {
  std::vector<Eigen::Vector2d> points;  // [px] of the picture, kPoints of them
  double presence = 0;                  // of a face, 0 to 1
};

/// MediaPipe's face mesh, read from an ONNX file and run by OpenCV on the thread that asks
/// (Kartynnik et al., "Real-time Facial Surface Geometry from Monocular Video on Mobile GPUs",
/// 2019).
class Network {
 public:
  static constexpr int kPixels = 192;  // a picture is as wide and as high

  /// Reads `file`; or says why it cannot be read, or is another network, and what makes the right
  /// one.
  static Expected<std::unique_ptr<Network>> read(const std::string& file);
  ~Network();

  /// The picture that `look` sees: kPixels x kPixels grey values, 0 to 1, row by row.
  std::span<float> picture();
  /// The mesh of the picture. Throws what OpenCV throws. Allocates.
  Mesh look();

 private:
  struct Parts;
  explicit Network(std::unique_ptr<Parts> parts);
  std::string misfit();

  std::unique_ptr<Parts> parts_;
};

}  // namespace armature::landmarks::face_mesh
