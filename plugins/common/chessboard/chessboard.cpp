// SPDX-License-Identifier: Apache-2.0
#include "chessboard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "corner_grid.hpp"
#include "saddle_points.hpp"

namespace armature::chessboard {
namespace {

using Eigen::Vector2d;
using Corners = std::vector<Vector2d>;

/// The first and last place of a grid.
struct Extent {
  int left, top, columns, rows;
};

Extent extent_of(const CornerGrid& grid) {
  int left = 0, top = 0, right = 0, bottom = 0;
  for (const auto& [place, point] : grid) {
    left = std::min(left, place.first);
    right = std::max(right, place.first);
    top = std::min(top, place.second);
    bottom = std::max(bottom, place.second);
  }
  return {left, top, right - left + 1, bottom - top + 1};
}

bool is_whole(const Extent& extent, const CornerGrid& grid, const BoardShape& shape) {
  const bool fits = (extent.columns == shape.columns && extent.rows == shape.rows) ||
                    (extent.columns == shape.rows && extent.rows == shape.columns);
  return fits && static_cast<int>(grid.size()) == shape.corners();
}

/// Row by row, and not mirrored: from the first column to the second is on the left hand of who
/// goes from the first row to the second.
Corners in_rows(const CornerGrid& grid, const std::vector<SaddlePoint>& points,
                const BoardShape& shape) {
  const auto [left, top, columns, rows] = extent_of(grid);
  const bool turned = columns != shape.columns;
  Corners corners;
  for (int row = 0; row < shape.rows; ++row) {
    for (int column = 0; column < shape.columns; ++column) {
      const std::pair<int, int> place =
          turned ? std::pair{left + row, top + column} : std::pair{left + column, top + row};
      corners.push_back(points[grid.at(place)].at);
    }
  }
  const Vector2d along = corners[1] - corners[0];
  const Vector2d down = corners[static_cast<std::size_t>(shape.columns)] - corners[0];
  if (along.x() * down.y() - along.y() * down.x() < 0) {
    for (auto row = corners.begin(); row != corners.end(); row += shape.columns) {
      std::reverse(row, row + shape.columns);
    }
  }
  return corners;
}

/// The same board of equal sides, counted from its next corner on.
Corners quarter_turned(const Corners& corners, int side) {
  Corners turned;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      turned.push_back(corners[static_cast<std::size_t>((side - 1 - column) * side + row)]);
    }
  }
  return turned;
}

/// Of all ways to count a board whose colours tell no beginning, the one whose last corner lies
/// farthest in the direction `towards` from its first one.
Corners counted_towards(Corners corners, const BoardShape& shape, const Vector2d& towards) {
  std::vector<Corners> ways{corners};
  if (shape.columns == shape.rows) {
    for (int i = 0; i < 3; ++i) ways.push_back(quarter_turned(ways.back(), shape.columns));
  } else {
    std::ranges::reverse(corners);
    ways.push_back(std::move(corners));
  }
  return *std::ranges::max_element(
      ways, {}, [&](const Corners& way) { return towards.dot(way.back() - way.front()); });
}

double brightness(const cv::Mat& gray, const Vector2d& at) {
  const int u = static_cast<int>(std::lround(at.x())), v = static_cast<int>(std::lround(at.y()));
  const cv::Rect around = cv::Rect{u - 1, v - 1, 3, 3} & cv::Rect{0, 0, gray.cols, gray.rows};
  return cv::mean(gray(around))[0];
}

/// Whether the first square between corners is darker than its neighbour.
bool begins_black(const cv::Mat& gray, const Corners& corners, const BoardShape& shape) {
  const auto square = [&](int column) {
    const auto a = static_cast<std::size_t>(column);
    const auto b = a + static_cast<std::size_t>(shape.columns);
    return brightness(gray, 0.25 * (corners[a] + corners[a + 1] + corners[b] + corners[b + 1]));
  };
  return square(0) < square(1);
}

void refine(const cv::Mat& gray, Corners& corners, const BoardShape& shape) {
  constexpr int kMinReach = 2, kMaxReach = 10, kMaxSteps = 60;
  constexpr double kStill = 1e-4, kOfASquare = 0.35;
  double shortest = 1e9;
  for (std::size_t i = 0; i + static_cast<std::size_t>(shape.columns) < corners.size(); ++i) {
    const Vector2d& below = corners[i + static_cast<std::size_t>(shape.columns)];
    shortest = std::min({shortest, (below - corners[i]).norm(),
                         (i + 1) % static_cast<std::size_t>(shape.columns) == 0
                             ? shortest
                             : (corners[i + 1] - corners[i]).norm()});
  }
  const int reach = std::clamp(static_cast<int>(kOfASquare * shortest), kMinReach, kMaxReach);
  std::vector<cv::Point2f> points;
  for (const Vector2d& corner : corners) {
    points.emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()));
  }
  cv::cornerSubPix(gray, points, {reach, reach}, {-1, -1},
                   {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, kMaxSteps, kStill});
  std::ranges::transform(points, corners.begin(), [](const cv::Point2f& point) {
    return Vector2d{point.x, point.y};
  });
}

}  // namespace

Expected<Corners> find_board(std::span<const std::uint8_t> pixels, int width, int height,
                             const BoardShape& shape, const Vector2d& towards) {
  constexpr std::size_t kCandidates = 4, kSeeds = 40;
  const cv::Mat gray{height, width, CV_8UC1, const_cast<std::uint8_t*>(pixels.data())};
  const std::size_t corners_of_board = static_cast<std::size_t>(shape.corners());
  const auto points = saddle_points(gray, kCandidates * corners_of_board);
  std::optional<CornerGrid> board;
  CornerGrid largest;
  for (std::size_t seed = 0; seed < std::min(kSeeds, points.size()) && !board; ++seed) {
    CornerGrid grid = grown_grid(points, seed);
    if (is_whole(extent_of(grid), grid, shape)) {
      board = std::move(grid);
    } else if (grid.size() > largest.size()) {
      largest = std::move(grid);
    }
  }
  if (!board) {
    const Extent seen = extent_of(largest);
    return refuse(fmt::format(
        "{} corners are asked for, {} x {}; the largest grid that is seen has {}, {} x {}",
        shape.corners(), shape.columns, shape.rows, largest.size(),
        largest.empty() ? 0 : std::max(seen.columns, seen.rows),
        largest.empty() ? 0 : std::min(seen.columns, seen.rows)));
  }
  Corners corners = in_rows(*board, points, shape);
  const bool told_by_colour = (shape.columns + shape.rows) % 2 != 0;
  if (!told_by_colour) {
    corners = counted_towards(std::move(corners), shape, towards);
  } else if (!begins_black(gray, corners, shape)) {
    std::ranges::reverse(corners);
  }
  refine(gray, corners, shape);
  return corners;
}

}  // namespace armature::chessboard
