// SPDX-License-Identifier: Apache-2.0
#include "corner_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>

namespace armature::chessboard {
namespace {

using Eigen::Vector2d;

constexpr double kOfAStep = 0.33;  // how far a corner may be from where it is expected

/// The nearest point within 20 degrees of a direction and its opposite.
std::optional<std::size_t> next_along(const std::vector<SaddlePoint>& points, std::size_t from,
                                      const Vector2d& direction) {
  constexpr double kCos = 0.94;
  std::optional<std::size_t> nearest;
  double distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector2d way = points[i].at - points[from].at;
    if (i == from || way.norm() >= distance || std::abs(way.dot(direction)) < kCos * way.norm()) {
      continue;
    }
    nearest = i;
    distance = way.norm();
  }
  return nearest;
}

std::optional<std::size_t> nearest_to(const std::vector<SaddlePoint>& points, const Vector2d& at,
                                      double within) {
  std::optional<std::size_t> nearest;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = (points[i].at - at).norm();
    if (distance >= within) continue;
    nearest = i;
    within = distance;
  }
  return nearest;
}

struct Node {
  std::pair<int, int> place;
  std::size_t point;
  std::array<Vector2d, 2> step;  // to the next column and row, as far as it is known
};

}  // namespace

CornerGrid grown_grid(const std::vector<SaddlePoint>& points, std::size_t seed) {
  CornerGrid grid;
  const auto column = next_along(points, seed, points[seed].first);
  const auto row = next_along(points, seed, points[seed].second);
  if (!column || !row) return grid;
  std::vector<bool> taken(points.size(), false);
  std::deque<Node> open;
  const auto place = [&](Node node) {
    grid.emplace(node.place, node.point);
    taken[node.point] = true;
    open.push_back(std::move(node));
  };
  place({{0, 0}, seed, {points[*column].at - points[seed].at, points[*row].at - points[seed].at}});
  while (!open.empty()) {
    const Node node = open.front();
    open.pop_front();
    for (const auto& [along, sign] : {std::pair{0, 1}, {0, -1}, {1, 1}, {1, -1}}) {
      const auto axis = static_cast<std::size_t>(along);
      const std::pair<int, int> next{node.place.first + (along == 0 ? sign : 0),
                                     node.place.second + (along == 1 ? sign : 0)};
      if (grid.contains(next)) continue;
      const Vector2d& step = node.step[axis];
      const Vector2d& at = points[node.point].at;
      const auto found = nearest_to(points, at + sign * step, kOfAStep * step.norm());
      if (!found || taken[*found]) continue;
      Node grown{next, *found, node.step};
      grown.step[axis] = sign * (points[*found].at - at);
      place(std::move(grown));
    }
  }
  return grid;
}

}  // namespace armature::chessboard
