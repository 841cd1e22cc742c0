// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "armature/config/node.hpp"
#include "armature/config/problems.hpp"
#include "lens.hpp"

namespace armature::stereo {

/// Reads the matrices of a calibration, `{rows: 3, cols: 3, data: [...]}`, by their keys. What is
/// wrong is noted at its place; keys that nobody asks for do not count, as such files have many.
class MatrixReader {
 public:
  MatrixReader(const config::Node& root, config::Problems& problems)
      : root_{root}, problems_{problems} {}

  bool has(const std::string& key) const { return root_.find(key) != nullptr; }
  /// All finite, row by row; nothing when it is missing or wrong.
  std::optional<Eigen::MatrixXd> matrix(const std::string& key, int rows, int columns);
  /// One row or column of any length.
  std::optional<std::vector<double>> list(const std::string& key);
  /// A camera matrix and its distortion.
  std::optional<Lens> lens(const std::string& camera_key, const std::string& distortion_key);
  /// A rotation, made exactly one where its numbers are rounded.
  std::optional<Eigen::Matrix3d> rotation(const std::string& key);
  /// 1 to 16384, 0 where the key is missing.
  int pixels(const std::string& key);
  void problem(const std::string& key, const std::string& message);

 private:
  struct Content {
    int rows, columns;
    std::vector<double> numbers;
  };
  std::optional<Content> read(const std::string& key);
  std::optional<int> dimension(const config::Node& map, const std::string& key,
                               const char* dimension);

  const config::Node& root_;
  config::Problems& problems_;
};

}  // namespace armature::stereo
