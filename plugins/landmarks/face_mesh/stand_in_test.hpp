// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "conversion_test.hpp"
#include "mirrored_points.hpp"
#include "tflite_writer_test.hpp"

namespace armature::landmarks::face_mesh {

/// A network with the inputs and outputs of the face mesh, for tests where that is not there. Its
/// points are those of an upright face of 137 px in the middle of the picture; they move down by
/// how much brighter the picture's left side is than its right one, by 20 px for white and black.
/// The presence is 1/2 where the picture's middle is of grey value 64.
inline std::string stand_in_tflite(std::size_t points = kPoints) {
  namespace tfl = tflite;
  const auto count = static_cast<std::int32_t>(3 * points);
  std::vector<float> mesh(3 * points), looks(27 * 3 * points);
  for (std::size_t i = 0; i < points; ++i) {
    mesh[3 * i] = 95.5f;
    mesh[3 * i + 1] = 110;
    looks[27 * (3 * i + 1) + 9] = 20;    // the pixel in the middle row, on the left, first colour
    looks[27 * (3 * i + 1) + 15] = -20;  // the one on the right
  }
  const auto place = [&](std::initializer_list<std::size_t> which, float x, float y) {
    for (const std::size_t i : which) {
      for (const auto& [point, at] : {std::pair{i, x}, std::pair{kMirroredPoints[i], 191 - x}}) {
        if (point >= points) continue;
        mesh[3 * point] = at;
        mesh[3 * point + 1] = y;
      }
    }
  };
  place({10}, 95.5f, 27);
  place({152}, 95.5f, 164);
  place({33, 160, 158, 133, 153, 144}, 65.5f, 80);
  place({78, 191, 80, 81, 82, 13, 14, 87, 178, 88, 95}, 95.5f, 130);
  std::vector<float> brightness(27);
  brightness[12] = 32;  // of the pixel in the middle
  tfl::Network n;
  const int in = n.input({1, 192, 192, 3});
  const int small = n.run(tfl::max_pool, {in}, {1, 3, 3, 3},
                          {{0, tfl::valid}, {1, 64}, {2, 64}, {3, 64}, {4, 64}});
  const std::vector<tfl::Field> plain{{0, tfl::valid}, {1, 1}, {2, 1}};
  const int out =
      n.run(tfl::conv, {small, n.weights({count, 3, 3, 3}, looks), n.weights({count}, mesh)},
            {1, 1, 1, count}, plain);
  const int presence =
      n.run(tfl::conv, {small, n.weights({1, 3, 3, 3}, brightness), n.weights({1}, {-8})},
            {1, 1, 1, 1}, plain);
  return n.file({out, presence});
}

/// The stand-in as the ONNX file that the plugin reads.
inline std::string stand_in_onnx(const std::string& name, std::size_t points = kPoints) {
  const std::string file = temporary(name);
  const Told told = converted(stand_in_tflite(points), file);
  if (!told.succeeded) throw std::runtime_error(told.text);
  return file;
}

}  // namespace armature::landmarks::face_mesh
