// SPDX-License-Identifier: Apache-2.0
#include "matrix_reader.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>

#include "armature/config/conversion.hpp"

namespace armature::stereo {
namespace {

constexpr int kMaxDimension = 100;
constexpr int kMaxPixels = 16384;
constexpr double kRounded = 1e-3;  // what numbers of a rotation may be off

}  // namespace

void MatrixReader::problem(const std::string& key, const std::string& message) {
  const config::Node* node = root_.find(key);
  problems_.add(node ? node->origin() : root_.origin(), message);
}

std::optional<int> MatrixReader::dimension(const config::Node& map, const std::string& key,
                                           const char* name) {
  const config::Node* node = map.find(name);
  const auto value = node ? config::to_integer(*node) : config::Converted<std::int64_t>{0};
  if (value && *value >= 1 && *value <= kMaxDimension) return static_cast<int>(*value);
  problems_.add(node ? node->origin() : map.origin(),
                fmt::format("'{}' needs '{}', a number from 1 to {}", key, name, kMaxDimension));
  return std::nullopt;
}

std::optional<MatrixReader::Content> MatrixReader::read(const std::string& key) {
  const config::Node* node = root_.find(key);
  if (!node) {
    problem(key, fmt::format("missing '{}', a matrix: {{rows: .., cols: .., data: [..]}}", key));
    return std::nullopt;
  }
  if (node->kind() != config::Node::Kind::map) {
    problem(key, fmt::format("'{}' must be a matrix, {{rows: .., cols: .., data: [..]}}, not {}",
                             key, node->describe()));
    return std::nullopt;
  }
  const auto rows = dimension(*node, key, "rows"), columns = dimension(*node, key, "cols");
  const config::Node* data = node->find("data");
  if (!data) problem(key, fmt::format("'{}' has no 'data'", key));
  if (!rows || !columns || !data) return std::nullopt;
  auto numbers = config::to_numbers(*data, static_cast<std::size_t>(*rows * *columns));
  if (!numbers) {
    problems_.add(numbers.error().origin, fmt::format("'data' of '{}' ({} x {}) {}", key, *rows,
                                                      *columns, numbers.error().message));
    return std::nullopt;
  }
  if (!std::ranges::all_of(*numbers, [](double number) { return std::isfinite(number); })) {
    problem(key, fmt::format("'{}' has numbers that are not finite", key));
    return std::nullopt;
  }
  return Content{*rows, *columns, std::move(*numbers)};
}

std::optional<Eigen::MatrixXd> MatrixReader::matrix(const std::string& key, int rows, int columns) {
  const auto content = read(key);
  if (!content) return std::nullopt;
  if (content->rows != rows || content->columns != columns) {
    problem(key, fmt::format("'{}' is {} x {}, not {} x {}", key, content->rows, content->columns,
                             rows, columns));
    return std::nullopt;
  }
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>{content->numbers.data(), rows, columns};
}

std::optional<std::vector<double>> MatrixReader::list(const std::string& key) {
  auto content = read(key);
  if (!content) return std::nullopt;
  if (content->rows != 1 && content->columns != 1) {
    problem(key, fmt::format("'{}' is {} x {}, not one row or column", key, content->rows,
                             content->columns));
    return std::nullopt;
  }
  return std::move(content->numbers);
}

std::optional<Lens> MatrixReader::lens(const std::string& camera_key,
                                       const std::string& distortion_key) {
  const auto k = matrix(camera_key, 3, 3);
  auto d = list(distortion_key);
  if (!k || !d) return std::nullopt;
  const Eigen::Matrix3d& m = *k;
  if (m(0, 0) <= 0 || m(1, 1) <= 0 || m(0, 1) != 0 || m(1, 0) != 0 || m(2, 0) != 0 ||
      m(2, 1) != 0 || m(2, 2) != 1) {
    problem(camera_key, fmt::format("'{}' must be [fx, 0, cx, 0, fy, cy, 0, 0, 1] with fx and fy "
                                    "above 0, row by row",
                                    camera_key));
    return std::nullopt;
  }
  Lens lens{.fx = m(0, 0), .fy = m(1, 1), .cx = m(0, 2), .cy = m(1, 2)};
  const std::size_t known = std::min(d->size(), lens.distortion.size());
  const auto rest = d->begin() + static_cast<std::ptrdiff_t>(known);
  constexpr std::array<std::size_t, 5> kCounts{4, 5, 8, 12, 14};  // as OpenCV writes them
  if (std::ranges::find(kCounts, d->size()) == kCounts.end() ||
      std::any_of(rest, d->end(), [](double further) { return further != 0; })) {
    problem(
        distortion_key,
        fmt::format("'{}' has {} coefficients; known are k1, k2, p1, p2, of which k3 and then k4, "
                    "k5, k6 may follow: 4, 5 or 8, and zeros behind them",
                    distortion_key, d->size()));
    return std::nullopt;
  }
  std::copy(d->begin(), rest, lens.distortion.begin());
  return lens;
}

std::optional<Eigen::Matrix3d> MatrixReader::rotation(const std::string& key) {
  const auto given = matrix(key, 3, 3);
  if (!given) return std::nullopt;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd{Eigen::Matrix3d{*given},
                                              Eigen::ComputeFullU | Eigen::ComputeFullV};
  const Eigen::Matrix3d nearest = svd.matrixU() * svd.matrixV().transpose();
  const double off = (nearest - *given).cwiseAbs().maxCoeff();
  if (nearest.determinant() > 0 && off <= kRounded) return nearest;
  problem(key,
          fmt::format("'{}' is no rotation: {}", key,
                      nearest.determinant() > 0
                          ? fmt::format("its numbers are up to {:.3g} off the nearest one", off)
                          : "it mirrors"));
  return std::nullopt;
}

int MatrixReader::pixels(const std::string& key) {
  const config::Node* node = root_.find(key);
  if (!node) return 0;
  const auto value = config::to_integer(*node);
  if (value && *value >= 1 && *value <= kMaxPixels) return static_cast<int>(*value);
  problem(key, fmt::format("'{}' must be a number of pixels from 1 to {}, not {}", key, kMaxPixels,
                           node->describe()));
  return 0;
}

}  // namespace armature::stereo
