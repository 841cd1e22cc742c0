// SPDX-License-Identifier: Apache-2.0
#include "reference_check.hpp"

#include <fmt/format.h>

#include <cmath>

namespace armature::test {
namespace {

// What rounding adds to differences of numbers of the size of a turn.
constexpr double kRounding = 1e-10;
constexpr double kLimitSlack = 1e-3;  // of a limit

std::optional<std::string> exceeded(const char* what, const Eigen::VectorXd& difference,
                                    double limit) {
  for (Eigen::Index joint = 0; joint < difference.size(); ++joint) {
    if (std::abs(difference[joint]) <= limit) continue;  // false for NaN
    return fmt::format("{} of joint {} by {:.3g}, at most {:.3g}", what, joint + 1,
                       difference[joint], limit);
  }
  return std::nullopt;
}

std::optional<std::string> step_defect(const ReferenceSample& from, const ReferenceSample& to,
                                       const ReferenceLimits& limits) {
  const double h = 1e-9 * static_cast<double>(to.ns - from.ns);
  const double J = limits.jerk;
  if (h < 0 || h > limits.period_s * (1 + 1e-9)) {
    return fmt::format("{} ns without a sample", to.ns - from.ns);
  }
  const Eigen::VectorXd dq = to.q - from.q - from.v * h - from.a * (h * h / 2);
  const Eigen::VectorXd dv = to.v - from.v - from.a * h;
  if (auto jump = exceeded("a jump in position", dq, J * h * h * h / 6 + kRounding)) return jump;
  if (auto jump = exceeded("a jump in velocity", dv, J * h * h / 2 + kRounding)) return jump;
  return exceeded("a jump in acceleration", to.a - from.a, J * h * (1 + 1e-9) + kRounding);
}

}  // namespace

std::optional<std::string> reference_defect(const std::vector<ReferenceSample>& reference,
                                            const ReferenceLimits& limits) {
  for (std::size_t k = 0; k < reference.size(); ++k) {
    const ReferenceSample& now = reference[k];
    auto defect = exceeded("velocity", now.v, limits.velocity * (1 + kLimitSlack));
    if (!defect) {
      defect = exceeded("acceleration", now.a, limits.acceleration * (1 + kLimitSlack));
    }
    if (!defect && k > 0) defect = step_defect(reference[k - 1], now, limits);
    if (defect) return fmt::format("at {:.3f} s: {}", 1e-9 * static_cast<double>(now.ns), *defect);
  }
  return std::nullopt;
}

}  // namespace armature::test
