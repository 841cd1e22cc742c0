// SPDX-License-Identifier: Apache-2.0
#include "pose_path.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

#include "armature/config/problems.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/values/regular_file.hpp"
#include "armature/values/without_blanks.hpp"

namespace armature::sim::surgeon {
namespace {

using Eigen::Vector3d;

constexpr std::array kColumns{"t", "x", "y", "z", "qx", "qy", "qz", "qw"};
using Numbers = std::array<double, kColumns.size()>;

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const auto comma = line.find(',');
    fields.push_back(without_blanks(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

bool names_columns(const std::vector<std::string_view>& fields) {
  return std::ranges::equal(fields, kColumns);
}

Expected<Numbers> numbers_of(const std::vector<std::string_view>& fields) {
  if (fields.size() != kColumns.size()) {
    return refuse(fmt::format("{} values; a row has 8: t, x, y, z, qx, qy, qz, qw", fields.size()));
  }
  Numbers numbers{};
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const char* const end = fields[i].data() + fields[i].size();
    const auto [rest, error] = std::from_chars(fields[i].data(), end, numbers[i]);
    if (error != std::errc{} || rest != end) {
      return refuse(
          fmt::format("{} is {}, not a number", kColumns[i], config::in_quotes(fields[i])));
    }
    if (!std::isfinite(numbers[i])) {
      return refuse(fmt::format("{} is {}, not a finite number", kColumns[i], fields[i]));
    }
  }
  return numbers;
}

Expected<PosePath::Row> row_of(double t, const Vector3d& position,
                               const Eigen::Quaterniond& rotation) {
  if (std::abs(rotation.norm() - 1) > 0.01) {
    return refuse(fmt::format("the quaternion has length {:.4g}, not 1", rotation.norm()));
  }
  return PosePath::Row{.t = t, .position = position, .rotation = rotation.normalized()};
}

Expected<PosePath::Row> row_of(const std::vector<std::string_view>& fields) {
  const auto numbers = numbers_of(fields);
  if (!numbers) return tl::unexpected{numbers.error()};
  const auto& [t, x, y, z, qx, qy, qz, qw] = *numbers;
  return row_of(t, {x, y, z}, {qw, qx, qy, qz});
}

Expected<PosePath::Row> row_of(double t, const msg::Pose& pose) {
  const Vector3d position = to_eigen(pose.position_());
  const Eigen::Quaterniond rotation = to_eigen(pose.orientation_());
  if (!position.allFinite() || !rotation.coeffs().allFinite()) {
    return refuse("a number is not finite");
  }
  return row_of(t, position, rotation);
}

}  // namespace

PosePath::PosePath(std::vector<Row> rows) : rows_{std::move(rows)} {
  std::vector<double> knots;
  std::vector<JointVector> points;
  for (const Row& row : rows_) {
    knots.push_back(row.t - rows_.front().t);
    points.emplace_back(row.position - rows_.front().position);
  }
  const JointVector zero = JointVector::Zero(3);
  positions_ =
      cubic_spline(knots, points, {points.front(), zero, zero}, {points.back(), zero, zero});
}

Eigen::Isometry3d PosePath::moved(double t) const {
  const double at = std::clamp(t, 0.0, duration_s());
  const auto& knots = positions_.knots;
  const auto piece = std::min<std::ptrdiff_t>(
      std::max<std::ptrdiff_t>(std::ranges::upper_bound(knots, at) - knots.begin() - 1, 0),
      std::ssize(knots) - 2);
  Vector3d way;
  for (std::ptrdiff_t i = 0; i < 3; ++i) {
    const Quintic& cubic = positions_.pieces[static_cast<std::size_t>(3 * piece + i)];
    way[i] = cubic.position(at - knots[static_cast<std::size_t>(piece)]);
  }
  const double time = rows_.front().t + at;
  const auto next = std::clamp(std::ranges::upper_bound(rows_, time, {}, &Row::t),
                               rows_.begin() + 1, rows_.end() - 1);
  const auto last = std::prev(next);
  const double part = std::clamp((time - last->t) / (next->t - last->t), 0.0, 1.0);
  const Eigen::Quaterniond turned = last->rotation.slerp(part, next->rotation);
  return Eigen::Translation3d{way} * (turned * rows_.front().rotation.conjugate());
}

Expected<PosePath> read_pose_path(std::string_view text, std::string_view name) {
  std::vector<PosePath::Row> rows;
  std::istringstream lines{std::string{text}};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::string_view content = without_blanks(line);
    if (content.empty() || content.front() == '#') continue;
    const auto fields = fields_of(content);
    if (rows.empty() && names_columns(fields)) continue;
    const auto row = row_of(fields);
    if (!row) return refuse(fmt::format("{}:{}: {}", name, number, row.error().text));
    if (!rows.empty() && row->t <= rows.back().t) {
      return refuse(fmt::format("{}:{}: t is {:g}, not after the {:g} of the row before", name,
                                number, row->t, rows.back().t));
    }
    rows.push_back(*row);
  }
  if (rows.size() < 2) {
    return refuse(
        fmt::format("{} has {} rows of poses; a path has two at least", name, rows.size()));
  }
  return PosePath{std::move(rows)};
}

Expected<PosePath> load_pose_path(const std::filesystem::path& file) {
  constexpr std::size_t kMaxBytes = std::size_t{64} << 20U;
  const auto text = bytes_of_regular(file, kMaxBytes);
  if (!text) return refuse(fmt::format("cannot read '{}': {}", file.string(), text.error().text));
  return read_pose_path(*text, file.string());
}

Expected<PosePath> pose_path_through(const msg::PoseArray& poses, double speed,
                                     std::string_view name) {
  constexpr double kTurnSpeed_rad_s = 0.5, kSameTime_s = 1e-9;
  std::vector<PosePath::Row> rows;
  for (std::size_t i = 0; i < poses.poses_().size(); ++i) {
    auto row = row_of(0, poses.poses_()[i]);
    if (!row) return refuse(fmt::format("pose {} of {}: {}", i + 1, name, row.error().text));
    if (!rows.empty()) {
      const PosePath::Row& last = rows.back();
      const double takes_s =
          std::max((row->position - last.position).norm() / speed,
                   row->rotation.angularDistance(last.rotation) / kTurnSpeed_rad_s);
      if (takes_s < kSameTime_s) continue;
      if (!std::isfinite(takes_s)) {
        return refuse(fmt::format("pose {} of {}: the way there has no length", i + 1, name));
      }
      row->t = last.t + takes_s;
    }
    rows.push_back(*row);
  }
  if (rows.size() < 2) {
    return refuse(
        fmt::format("{} has {} different poses; a path has two at least", name, rows.size()));
  }
  return PosePath{std::move(rows)};
}

}  // namespace armature::sim::surgeon
