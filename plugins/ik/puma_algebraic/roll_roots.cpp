// SPDX-License-Identifier: Apache-2.0
#include "roll_roots.hpp"

#include <cmath>
#include <limits>

#include "line_search.hpp"

namespace armature {
namespace {

constexpr double kRoot = 1e-10;  // [rad] larger errors at a change of sign are a jump, not a root

struct Sample {
  double depth = 0, error = 0;
};

/// Follows the roll error of one shoulder and elbow through the depths of a line, and notes the
/// roots.
class RootsOfArm {
 public:
  RootsOfArm(const NeedleLine& line, std::size_t arm, RollRoots::Depths& found)
      : line_{&line}, arm_{arm}, found_{&found} {}

  void follow(const Sample& next) {
    if (next.error == 0) {
      add(next.depth);
    } else if (here_.error * next.error < 0) {
      add(zero(here_, next));
    } else {
      touch(before_, here_, next);
    }
    before_ = here_, here_ = next;
  }

 private:
  static constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();

  double error(double depth) const {
    double errors[4];
    line_->kernel().roll_errors(line_->arm(), line_->at(depth), errors);
    return errors[arm_];
  }
  double zero(const Sample& a, const Sample& b) const {
    return last_where(a.depth, b.depth, [&](double depth) { return error(depth) * a.error > 0; });
  }

  /// |error| is least in the middle and has one sign: it may touch zero or cross it twice.
  void touch(const Sample& a, const Sample& middle, const Sample& b) {
    const bool least =
        std::abs(middle.error) < std::abs(a.error) && std::abs(middle.error) < std::abs(b.error);
    if (!least || !(a.error * middle.error > 0)) return;
    const double sign = middle.error > 0 ? -1 : 1;
    const double depth =
        golden_maximum(a.depth, b.depth, [&](double at) { return sign * error(at); });
    const Sample nearest{depth, error(depth)};
    if (nearest.error * middle.error < 0) {
      add(zero(a, nearest));
      add(zero(b, nearest));
    } else {
      add(depth);
    }
  }

  /// Notes a root, unless it is a jump through zero.
  void add(double depth) {
    if (found_->count == RollRoots::kMost || !(std::abs(error(depth)) <= kRoot)) return;
    constexpr double kStep = 1e-6;
    const double slope = (error(depth + kStep) - error(depth - kStep)) / (2 * kStep);
    found_->root[static_cast<std::size_t>(found_->count++)] = {depth,
                                                               std::isnan(slope) ? 0 : slope};
  }

  const NeedleLine* line_;
  std::size_t arm_;
  RollRoots::Depths* found_;
  Sample before_{0, kNowhere}, here_{0, kNowhere};  // NaN: not reached, and unlike everything
};

}  // namespace

RollRoots roll_roots(const NeedleLine& line) {
  RollRoots roots;
  std::array arms{RootsOfArm{line, 0, roots.of[0]}, RootsOfArm{line, 1, roots.of[1]},
                  RootsOfArm{line, 2, roots.of[2]}, RootsOfArm{line, 3, roots.of[3]}};
  for (const double depth : line) {
    double errors[4];
    line.kernel().roll_errors(line.arm(), line.at(depth), errors);
    for (std::size_t i = 0; i < 4; ++i) {
      arms[i].follow({depth, errors[i]});
      if (std::abs(errors[i]) < roots.least_error) roots.least_error = std::abs(errors[i]);
    }
  }
  return roots;
}

}  // namespace armature
