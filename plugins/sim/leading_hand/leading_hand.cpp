// SPDX-License-Identifier: Apache-2.0
#include "leading_hand.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace armature::sim::leading_hand {
namespace {

using Eigen::Vector3d;

constexpr double kComesToRestIn_s = 0.3;
constexpr double kTurn = 2 * std::numbers::pi;

}  // namespace

LeadingHand::LeadingHand(const Parameters& parameters, std::uint64_t seed)
    : parameters_{parameters}, random_{seed} {
  std::uniform_real_distribution<double> frequency{8, 12}, phase{0, kTurn};
  for (double& each : tremor_hz_) each = frequency(random_);
  for (double& each : tremor_phase_) each = phase(random_);
}

std::vector<std::size_t> LeadingHand::order_of(std::size_t markers) {
  std::vector<std::size_t> order;
  for (const double number : parameters_.order) {
    order.push_back(static_cast<std::size_t>(number) - 1);
  }
  if (!order.empty()) return order;
  order.resize(markers);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random_);
  return order;
}

void LeadingHand::take_hold(const std::vector<Vector3d>& markers, const Vector3d& tip, Time now) {
  if (markers_.empty()) {
    markers_ = markers;
    order_ = order_of(markers.size());
    home_ = tip;
  }
  holds_ = true;
  pace_ = 1;
  at_ = tip;
  led_at_ = now;
  begin_way(visit_);
}

bool LeadingHand::has_more(const Touches& touches) {
  heed(touches);
  return touches.wanted && (order_.empty() || visit_ < order_.size());
}

void LeadingHand::heed(const Touches& touches) {
  if (touches.taken < taken_) visit_ -= std::min(visit_, taken_ - touches.taken);
  taken_ = touches.taken;
}

Vector3d LeadingHand::lead(const Touches& touches, bool halted, Time now) {
  const double passed_s = to_seconds(now - led_at_);
  led_at_ = now;
  const double change = passed_s / kComesToRestIn_s;
  pace_ = std::clamp(halted ? pace_ - change : pace_ + change, 0.0, 1.0);
  if (halted && pace_ == 0) {
    holds_ = false;
    return at_;
  }
  const std::optional<std::size_t> wanted =
      has_more(touches) ? std::optional{visit_} : std::nullopt;
  if (wanted != towards_) begin_way(wanted);
  on_way_s_ += pace_ * passed_s;
  at_ = way_.at(on_way_s_);
  if (on_way_s_ >= way_.duration_s()) rest(touches, now);
  return at_ + tremor(now);
}

void LeadingHand::rest(const Touches& touches, Time now) {
  if (!towards_) {
    holds_ = false;
    return;
  }
  if (!rests_since_) rests_since_ = now;
  const bool waited = touches.by_itself && now - *rests_since_ >= seconds(parameters_.rest);
  if (taken_ > taken_before_ || waited) ++visit_;
}

void LeadingHand::begin_way(std::optional<std::size_t> visit) {
  const Vector3d to = visit ? Vector3d{markers_[order_[*visit]] + touch_error()} : home_;
  way_ = TipWay{at_, to, parameters_.lift, parameters_.speed};
  towards_ = visit;
  taken_before_ = taken_;
  on_way_s_ = 0;
  rests_since_.reset();
}

Vector3d LeadingHand::touch_error() {
  std::normal_distribution<double> normal{0, 1};
  const double x = normal(random_), y = normal(random_), z = normal(random_);
  return parameters_.touch_error / std::sqrt(3.0) * Vector3d{x, y, z};
}

Vector3d LeadingHand::tremor(Time now) const {
  // A sine's rms is its amplitude over the square root of 2; three of them make the distance.
  const double amplitude = parameters_.tremor * std::sqrt(2.0 / 3.0);
  Vector3d tremor;
  for (std::size_t i = 0; i < 3; ++i) {
    const double t = to_seconds(now - Time{});
    tremor[static_cast<Eigen::Index>(i)] =
        amplitude * std::sin(kTurn * tremor_hz_[i] * t + tremor_phase_[i]);
  }
  return tremor;
}

}  // namespace armature::sim::leading_hand
