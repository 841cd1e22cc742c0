// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "armature/kinds/ik/contract/postures.hpp"
#include "armature/kinds/ik/contract/probe.hpp"
#include "armature/kinds/ik/contract/search.hpp"

namespace armature::ik_contract {
namespace {

constexpr int kSamples = 48;          // along a joint
constexpr double kSingular = 1e-9;    // smallest singular value
constexpr double kNearlyNice = 1e-6;  // [rad] or [m]
constexpr int kTimeout = 20;          // postures without a singular value of a joint

/// `value`, or the multiple of 45 degrees next to it when that is at least as singular.
template <class Function>
double nicest(double value, Range range, Function f) {
  constexpr double kStep = std::numbers::pi / 4;
  const double nice = kStep * std::round(value / kStep);
  const bool inside = nice >= range.lower && nice <= range.upper;
  if (!inside || std::abs(nice - value) > kNearlyNice) return value;
  return f(nice) <= f(value) + 1e-15 ? nice : value;
}

/// The values of joint `k` that make `q` singular.
std::vector<double> singular_values_of(const RobotModel& model, JointVector q, int k) {
  const auto at = [&](double value) {
    q[k] = value;
    return smallest_singular_value_at(model, q);
  };
  const Range range = range_of(model, k);
  const double step = (range.upper - range.lower) / (kSamples - 1);
  std::array<double, kSamples> f{};
  for (int i = 0; i < kSamples; ++i) f[static_cast<std::size_t>(i)] = at(range.lower + i * step);
  std::vector<double> values;
  for (std::size_t i = 0; i < f.size(); ++i) {
    const bool least = (i == 0 || f[i] <= f[i - 1]) && (i + 1 == f.size() || f[i] < f[i + 1]);
    if (!least) continue;
    const double here = range.lower + static_cast<double>(i) * step;
    double value =
        golden_section(std::max(here - step, range.lower), std::min(here + step, range.upper), at);
    value = nicest(value, range, at);
    if (at(value) <= kSingular) values.push_back(value);
  }
  return values;
}

}  // namespace

std::vector<SingularPosture> singular_postures(const RobotModel& model, int count, Random& random) {
  std::vector<SingularPosture> found;
  std::vector<int> failures(static_cast<std::size_t>(model.dof()), 0);
  const auto hopeless = [](int n) { return n >= kTimeout; };
  for (int k = 0; static_cast<int>(found.size()) < count; k = (k + 1) % model.dof()) {
    if (std::all_of(failures.begin(), failures.end(), hopeless)) break;
    int& failed = failures[static_cast<std::size_t>(k)];
    if (hopeless(failed)) continue;
    JointVector q = random_posture(model, random);
    const auto values = singular_values_of(model, q, k);
    if (values.empty()) {
      ++failed;
      continue;
    }
    failed = 0;
    q[k] = values[std::uniform_int_distribution<std::size_t>{0, values.size() - 1}(random)];
    found.push_back({q, k});
  }
  return found;
}

}  // namespace armature::ik_contract
