// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/registration/marker_matching.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "armature/kinds/registration/rigid_fit.hpp"

namespace armature {
namespace {

using Choice = std::vector<std::size_t>;

/// All choices that keep the distances, the two best of them by how well a rigid motion fits.
class Search {
 public:
  Search(std::span<const Eigen::Vector3d> planned, std::span<const Eigen::Vector3d> measured,
         double tolerance_m)
      : planned_{planned},
        measured_{measured},
        tolerance_m_{tolerance_m},
        taken_(measured.size(), false) {
    extend();
  }

  Expected<MarkerMatch> answer() const;

 private:
  struct Fit {
    Choice choice;
    double rms_m = std::numeric_limits<double>::infinity();
  };
  void extend();
  bool keeps_distances(std::size_t candidate);
  void consider();
  std::string exchanged() const;

  /// Counted in distances that are compared, a few nanoseconds each: a tenth of a second in all.
  static constexpr std::int64_t kMaxWork = 10'000'000, kWorkOfAFit = 500;
  std::span<const Eigen::Vector3d> planned_, measured_;
  double tolerance_m_;
  std::vector<bool> taken_;
  Choice choice_;
  std::int64_t work_ = 0;
  std::size_t deepest_ = 0;
  Fit best_, second_;
  double best_mirrored_m_ = std::numeric_limits<double>::infinity();
};

bool Search::keeps_distances(std::size_t candidate) {
  ++work_;
  for (std::size_t i = 0; i < choice_.size(); ++i) {
    ++work_;
    const double planned = (planned_[choice_.size()] - planned_[i]).norm();
    const double measured = (measured_[candidate] - measured_[choice_[i]]).norm();
    if (std::abs(planned - measured) > tolerance_m_) return false;
  }
  return true;
}

void Search::extend() {
  deepest_ = std::max(deepest_, choice_.size());
  if (choice_.size() == planned_.size()) return consider();
  for (std::size_t candidate = 0; candidate < measured_.size(); ++candidate) {
    if (work_ > kMaxWork) return;
    if (taken_[candidate] || !keeps_distances(candidate)) continue;
    taken_[candidate] = true;
    choice_.push_back(candidate);
    extend();
    choice_.pop_back();
    taken_[candidate] = false;
  }
}

void Search::consider() {
  work_ += kWorkOfAFit;
  std::vector<Eigen::Vector3d> to;
  for (const std::size_t i : choice_) to.push_back(measured_[i]);
  Fit fit{choice_, rms_of(rigid_fit(planned_, to), planned_, to)};
  best_mirrored_m_ = std::min(best_mirrored_m_, mirrored_rms(planned_, to));
  if (!(fit.rms_m <= tolerance_m_)) return;
  if (fit.rms_m < best_.rms_m) std::swap(fit, best_);
  if (fit.rms_m < second_.rms_m) second_ = std::move(fit);
}

/// Markers that the second choice takes for others: "markers 1, 3 may be exchanged".
std::string Search::exchanged() const {
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < planned_.size(); ++i) {
    if (best_.choice[i] != second_.choice[i]) others.push_back(i + 1);
  }
  if (others.size() > 1) return fmt::format("markers {} may be exchanged", fmt::join(others, ", "));
  const std::size_t i = others.front() - 1;
  const auto [one, other] = std::minmax(best_.choice[i], second_.choice[i]);
  return fmt::format("points {} and {} may both be marker {}, was it measured twice?", one + 1,
                     other + 1, i + 1);
}

Expected<MarkerMatch> Search::answer() const {
  if (work_ > kMaxWork) {
    return refuse(
        fmt::format("too many ways to match {} markers with {} points within {:.6g} mm: "
                    "lower the tolerance",
                    planned_.size(), measured_.size(), 1e3 * tolerance_m_));
  }
  if (best_.choice.empty()) {
    if (best_mirrored_m_ <= tolerance_m_) {
      return refuse(
          "the measured markers are the mirror image of the planned ones: is an axis of "
          "the images turned round?");
    }
    return refuse(
        fmt::format("no choice of measured points keeps the distances of marker {} to "
                    "those before it within {:.6g} mm",
                    std::min(deepest_ + 1, planned_.size()), 1e3 * tolerance_m_));
  }
  // Half the tolerance is three times the error of a marker: a wrong choice that fits as well.
  constexpr double kAlike = 2, kNoise = 0.1;
  if (second_.rms_m < kAlike * best_.rms_m + kNoise * tolerance_m_) {
    return refuse(fmt::format("ambiguous: {} (fits to {:.3f} mm, the other way to {:.3f} mm)",
                              exchanged(), 1e3 * best_.rms_m, 1e3 * second_.rms_m));
  }
  return MarkerMatch{best_.choice, best_mirrored_m_};
}

std::optional<std::string> unusable(std::span<const Eigen::Vector3d> planned,
                                    std::span<const Eigen::Vector3d> measured, double tolerance_m) {
  if (planned.size() < 3) return fmt::format("{} markers, at least 3 are needed", planned.size());
  if (measured.size() < planned.size()) {
    return fmt::format("{} markers are planned, {} points measured", planned.size(),
                       measured.size());
  }
  if (!(tolerance_m > 0 && std::isfinite(tolerance_m))) {
    return fmt::format("the tolerance is {} m", tolerance_m);
  }
  for (const auto& [points, what] :
       {std::pair{planned, "planned marker"}, std::pair{measured, "measured point"}}) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!points[i].allFinite()) return fmt::format("{} {} is not finite", what, i + 1);
    }
  }
  return std::nullopt;
}

}  // namespace

Expected<MarkerMatch> match_markers(std::span<const Eigen::Vector3d> planned,
                                    std::span<const Eigen::Vector3d> measured, double tolerance_m) {
  if (auto wrong = unusable(planned, measured, tolerance_m)) return refuse(std::move(*wrong));
  return Search{planned, measured, tolerance_m}.answer();
}

}  // namespace armature
