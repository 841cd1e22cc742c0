// SPDX-License-Identifier: Apache-2.0
#include "saddle_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace armature::chessboard {
namespace {

constexpr int kOnRing = 32;
constexpr float kMinContrast = 15;     // grey values between dark and bright
constexpr float kMinStrength = 0.02F;  // of the strongest one's
constexpr int kApart = 3;              // [px] of two saddle points, at least

float at(const cv::Mat& image, double x, double y) {
  const int u = static_cast<int>(x), v = static_cast<int>(y);
  const auto a = static_cast<float>(x - u), b = static_cast<float>(y - v);
  const auto *row = image.ptr<float>(v), *next = image.ptr<float>(v + 1);
  return (1 - b) * ((1 - a) * row[u] + a * row[u + 1]) + b * ((1 - a) * next[u] + a * next[u + 1]);
}

/// Where the brightness on a ring passes the middle between dark and bright, as angles; nothing
/// where there are not four such places.
std::optional<std::array<double, 4>> crossings(const cv::Mat& image, int u, int v, double radius) {
  std::array<float, kOnRing> ring{};
  const auto angle = [](double i) { return 2 * std::numbers::pi * i / kOnRing; };
  for (int i = 0; i < kOnRing; ++i) {
    ring[static_cast<std::size_t>(i)] =
        at(image, u + radius * std::cos(angle(i)), v + radius * std::sin(angle(i)));
  }
  const auto [dark, bright] = std::ranges::minmax(ring);
  if (bright - dark < kMinContrast) return std::nullopt;
  const float middle = 0.5F * (dark + bright);
  std::array<double, 4> found{};
  std::size_t count = 0;
  for (int i = 0; i < kOnRing; ++i) {
    const float here = ring[static_cast<std::size_t>(i)] - middle;
    const float next = ring[static_cast<std::size_t>((i + 1) % kOnRing)] - middle;
    if ((here < 0) == (next < 0)) continue;
    if (count == found.size()) return std::nullopt;
    found[count++] = angle(i + double{here} / (here - next));
  }
  if (count != found.size()) return std::nullopt;
  return found;
}

/// The unit vector half way between two directions that are nearly opposite, seen as a line.
Eigen::Vector2d line_along(double a, double b) {
  const Eigen::Vector2d one{std::cos(a), std::sin(a)}, other{std::cos(b), std::sin(b)};
  return (one - other).normalized();
}

std::optional<SaddlePoint> saddle_at(const cv::Mat& image, int u, int v, double radius,
                                     float strength) {
  constexpr double kStraight = 0.6;  // [rad] what an edge may bend in its corner
  const auto found = crossings(image, u, v, radius);
  if (!found) return std::nullopt;
  for (const std::size_t i : {0U, 1U}) {
    if (std::abs((*found)[i + 2] - (*found)[i] - std::numbers::pi) > kStraight) return std::nullopt;
  }
  return SaddlePoint{.at = {u, v},
                     .first = line_along((*found)[0], (*found)[2]),
                     .second = line_along((*found)[1], (*found)[3]),
                     .strength = strength};
}

/// Ixy^2 - Ixx Iyy of the blurred picture: above 0 at saddle points.
cv::Mat saddle_strength(const cv::Mat& image) {
  cv::Mat xx, yy, xy;
  cv::Sobel(image, xx, CV_32F, 2, 0);
  cv::Sobel(image, yy, CV_32F, 0, 2);
  cv::Sobel(image, xy, CV_32F, 1, 1);
  return xy.mul(xy) - xx.mul(yy);
}

}  // namespace

std::vector<SaddlePoint> saddle_points(const cv::Mat& gray, std::size_t max_count) {
  const double sigma = 1 + gray.cols / 1000.0;
  const double radius = 2.5 * sigma + 2;
  cv::Mat image;
  gray.convertTo(image, CV_32F);
  cv::GaussianBlur(image, image, {}, sigma);
  const cv::Mat strength = saddle_strength(image);
  cv::Mat highest;
  cv::dilate(strength, highest,
             cv::getStructuringElement(cv::MORPH_RECT, {2 * kApart + 1, 2 * kApart + 1}));
  double strongest = 0;
  cv::minMaxLoc(strength, nullptr, &strongest);

  const int rim = static_cast<int>(std::ceil(radius)) + 2;
  std::vector<SaddlePoint> points;
  for (int v = rim; v < gray.rows - rim; ++v) {
    const auto *here = strength.ptr<float>(v), *best = highest.ptr<float>(v);
    for (int u = rim; u < gray.cols - rim; ++u) {
      if (here[u] < best[u] || here[u] <= kMinStrength * static_cast<float>(strongest)) continue;
      if (const auto point = saddle_at(image, u, v, radius, here[u])) points.push_back(*point);
    }
  }
  std::ranges::stable_sort(points, std::greater{}, &SaddlePoint::strength);
  if (points.size() > max_count) points.resize(max_count);
  return points;
}

}  // namespace armature::chessboard
