// SPDX-License-Identifier: Apache-2.0
#include "armature/volume/slice_stack.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "armature/volume/volume_axes.hpp"

namespace armature {
namespace {

using Eigen::Vector3d;

std::string name_of(const DicomSlice& slice) { return slice.file.filename().string(); }

std::optional<std::string> mixed_series(const std::vector<DicomSlice>& slices) {
  std::map<std::string, int> count;
  for (const DicomSlice& slice : slices) ++count[slice.series];
  if (count.size() == 1) return std::nullopt;
  std::string text = fmt::format("{} series are mixed:", count.size());
  constexpr std::size_t kShown = 5;
  std::size_t told = 0;
  for (const auto& [series, files] : count) {
    if (told++ == kShown) return text + fmt::format(" and {} more", count.size() - kShown);
    text += fmt::format(" {} ({} files)", legible(series), files);
  }
  return text;
}

/// What every slice must have as the first one has it.
std::optional<std::string> unlike_first(const std::vector<DicomSlice>& slices) {
  const DicomSlice& first = slices.front();
  for (const DicomSlice& slice : slices) {
    const auto differs = [&](const char* what) {
      return fmt::format("the {} of '{}' and '{}' differ", what, name_of(first), name_of(slice));
    };
    if (slice.rows != first.rows || slice.columns != first.columns) return differs("sizes");
    constexpr double kRounding = 1e-4;
    if (std::abs(slice.row_step - first.row_step) > kRounding ||
        std::abs(slice.column_step - first.column_step) > kRounding) {
      return differs("pixel spacings");
    }
    if ((slice.along_row - first.along_row).norm() > kRounding ||
        (slice.along_column - first.along_column).norm() > kRounding) {
      return differs("orientations");
    }
  }
  return std::nullopt;
}

/// What a slice may lie beside its place, in steps.
constexpr double kEven = 0.02;

/// Of slices in order; `place` tells where one is along the normal [mm].
template <class Place>
std::optional<std::string> uneven_steps(const std::vector<DicomSlice>& slices, const Place& place) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < slices.size(); ++i) {
    steps.push_back(place(slices[i]) - place(slices[i - 1]));
  }
  std::vector<double> sorted = steps;
  std::ranges::sort(sorted);
  const double usual = sorted[sorted.size() / 2];
  constexpr double kSamePlace = 1e-3;  // [mm]
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const std::string names =
        fmt::format("'{}' and '{}'", name_of(slices[i]), name_of(slices[i + 1]));
    if (steps[i] < kSamePlace) return fmt::format("{} are slices of the same place", names);
    const double ratio = steps[i] / usual, whole = std::round(ratio);
    if (whole >= 2 && std::abs(ratio - whole) < kEven * whole) {
      return fmt::format("{:.0f} slices are missing between {}", whole - 1, names);
    }
    if (std::abs(ratio - 1) > kEven) {
      return fmt::format("the slices are unequally spaced: {:g} mm between {}, {:g} mm elsewhere",
                         steps[i], names, usual);
    }
  }
  return std::nullopt;
}

/// Of slices in order, in the plane and along the normal, with one step from each to the next.
std::optional<std::string> pushed_aside(const std::vector<DicomSlice>& slices,
                                        const Vector3d& step) {
  const DicomSlice& first = slices.front();
  const DicomSlice* farthest = &first;
  double most = 0;  // [mm]
  for (std::size_t i = 1; i < slices.size(); ++i) {
    const Vector3d due = first.position + static_cast<double>(i) * step;
    const double beside = (slices[i].position - due).norm();
    if (beside <= most) continue;
    most = beside;
    farthest = &slices[i];
  }
  const double taken = kEven * step.norm();
  if (most <= taken) return std::nullopt;
  return fmt::format(
      "'{}' lies {:.3g} mm beside its place in the row from '{}' to '{}'; up to "
      "{:.3g} mm are taken",
      name_of(*farthest), most, name_of(first), name_of(slices.back()), taken);
}

std::optional<std::string> not_whole(const std::vector<DicomSlice>& slices) {
  const auto expected = slices.front().of_acquisition;
  if (!expected || *expected == static_cast<int>(slices.size())) return std::nullopt;
  return fmt::format("it has {} slices of an acquisition of {}", slices.size(), *expected);
}

}  // namespace

Expected<Volume> stacked(std::vector<DicomSlice> slices) {
  if (slices.size() < 2) return refuse(fmt::format("{} slices are no volume", slices.size()));
  if (auto mixed = mixed_series(slices)) return refuse(std::move(*mixed));
  if (auto unlike = unlike_first(slices)) return refuse(std::move(*unlike));
  const Vector3d normal = slices.front().normal();
  const auto place = [&](const DicomSlice& slice) { return slice.position.dot(normal); };
  std::ranges::sort(slices, {}, place);
  if (auto uneven = uneven_steps(slices, place)) return refuse(std::move(*uneven));
  if (auto part = not_whole(slices)) return refuse(std::move(*part));
  const DicomSlice& first = slices.front();
  const auto count = static_cast<int>(slices.size());
  Volume volume{.geometry = {.size = {first.columns, first.rows, count}}};
  const Vector3d step = (slices.back().position - first.position) / (count - 1);
  if (auto aside = pushed_aside(slices, step)) return refuse(std::move(*aside));
  if (auto wrong = set_axes({1e-3 * first.column_step * first.along_row,
                             1e-3 * first.row_step * first.along_column, 1e-3 * step},
                            volume.geometry)) {
    return refuse(std::move(*wrong));
  }
  constexpr double kLevel_deg = 0.05;
  if (!(std::abs(first.gantry_tilt_deg) <= kLevel_deg)) {
    return refuse(
        fmt::format("its gantry was tilted by {:g} degrees (gantry tilt)", first.gantry_tilt_deg));
  }
  if (auto wrong = set_origin(1e-3 * first.position, volume.geometry)) {
    return refuse(std::move(*wrong));
  }
  volume.voxels.reserve(volume.geometry.count());
  for (DicomSlice& slice : slices) {
    volume.voxels.insert(volume.voxels.end(), slice.hounsfield.begin(), slice.hounsfield.end());
    slice.hounsfield = std::vector<std::int16_t>{};  // each is in memory once
  }
  return volume;
}

}  // namespace armature
