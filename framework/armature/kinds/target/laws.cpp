// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/target/laws.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <random>

namespace armature {
namespace {

struct Foreign {
  static constexpr auto kLayout = layout_id("target/another", 1);
  double number = 7;
};

/// Looks at a still target, with noise of 1 mm and 0.02 rad.
class Looker {
 public:
  TargetMeasurement look(double t_s) {
    return {
        .stamp = Time{} + seconds(t_s),
        .position = kMouth + 0.001 * noise(),
        .normal = (kNormal + 0.02 * noise()).normalized(),
        .position_covariance = 1e-6 * Eigen::Matrix3d::Identity(),
        .normal_covariance = 4e-4 * (Eigen::Matrix3d::Identity() - kNormal * kNormal.transpose())};
  }
  /// What `filter` remembers after ten looks, the last of them at 0.9 s.
  PluginState started(const TargetFilter& filter, LawCheck& check) {
    PluginState state;
    for (int i = 0; i < 10; ++i) {
      check.answered(filter.update(look(0.1 * i), state), "a look at a still target");
    }
    return state;
  }

 private:
  Eigen::Vector3d noise() { return {normal_(random_), normal_(random_), normal_(random_)}; }

  const Eigen::Vector3d kMouth{1.55, 0, 0.45};
  const Eigen::Vector3d kNormal{-1, 0, 0};
  std::mt19937_64 random_{1};
  std::normal_distribution<double> normal_;
};

void expect_same_prediction(const TargetFilter& filter, const PluginState& a, const PluginState& b,
                            LawCheck& check) {
  const Time when = Time{} + seconds(1.2);
  const auto first = filter.predict(when, a), second = filter.predict(when, b);
  if (!check.answered(first, "a prediction") || !check.answered(second, "a prediction")) return;
  check.that(first->position == second->position, "equal states predict equal positions");
  check.that(first->velocity == second->velocity, "equal states predict equal velocities");
  check.that(first->normal == second->normal, "equal states predict equal normals");
  check.that(first->normal_rate == second->normal_rate, "equal states predict equal rates");
  check.equal(first->measurements, second->measurements, "the number of measurements");
}

void starts_with_first(const TargetSubject& subject, LawCheck& check) {
  PluginState state;
  check.refused(subject.filter->predict(Time{}, state), "a prediction before the first look");
  const TargetMeasurement first = Looker{}.look(3);
  const auto estimate = subject.filter->update(first, state);
  if (!check.answered(estimate, "the first look")) return;
  check.that(estimate->stamp == first.stamp, "the estimate has the stamp of the look");
  check.equal(estimate->measurements, 1, "the number of measurements");
  check.at_most((estimate->position - first.position).norm(), 1e-12,
                "from the look to the estimate [m]");
  check.at_most((estimate->normal - first.normal).norm(), 1e-12,
                "from the normal that was seen to that of the estimate");
}

void normal_is_unit(const TargetSubject& subject, LawCheck& check) {
  PluginState state;
  Looker looker;
  for (int i = 0; i < 100; ++i) {
    check.asks(fmt::format("look {} of 100 at a still target", i + 1));
    const auto estimate = subject.filter->update(looker.look(0.1 * i), state);
    if (!check.answered(estimate, "a look at a still target")) return;
    check.near(estimate->normal.norm(), 1, 1e-9, "the normal's length");
    check.near(estimate->normal.dot(estimate->normal_rate), 0, 1e-9,
               "the part of the normal's rate along the normal [1/s]");
  }
}

void predicts_without_jump(const TargetSubject& subject, LawCheck& check) {
  Looker looker;
  PluginState state = looker.started(*subject.filter, check);
  const TargetMeasurement measurement = looker.look(1);
  const auto now = subject.filter->update(measurement, state);
  const auto same = subject.filter->predict(measurement.stamp, state);
  if (!check.answered(now, "a look") || !check.answered(same, "a prediction of this instant")) {
    return;
  }
  check.that(same->stamp == measurement.stamp, "the prediction has the stamp that was asked for");
  check.at_most((same->position - now->position).norm(), 1e-12,
                "from the estimate to the prediction of the same instant [m]");
  check.at_most((same->normal - now->normal).norm(), 1e-12,
                "from the estimate's normal to that of the prediction");
}

void remembers_only_state(const TargetSubject& subject, LawCheck& check) {
  const TargetFilter& filter = *subject.filter;
  Looker looker;
  PluginState state = looker.started(filter, check), copy = state, other;
  const TargetMeasurement next = looker.look(1), elsewhere = looker.look(7);
  const auto first = filter.update(next, state);
  static_cast<void>(filter.update(elsewhere, other));
  const auto second = filter.update(next, copy);
  if (!check.answered(first, "a look") || !check.answered(second, "the same look")) return;
  check.that(first->position == second->position, "equal looks give equal positions");
  check.that(first->normal == second->normal, "equal looks give equal normals");
  expect_same_prediction(filter, state, copy, check);
}

void refuses_bad(const TargetSubject& subject, LawCheck& check) {
  Looker looker;
  PluginState state = looker.started(*subject.filter, check);
  const PluginState before = state;
  const auto refused = [&](const std::string& what, auto change) {
    TargetMeasurement bad = looker.look(1);
    change(bad);
    check.asks(what);
    check.refused(subject.filter->update(bad, state), what);
    expect_same_prediction(*subject.filter, state, before, check);
  };
  refused("a position that is not finite", [](auto& bad) { bad.position.x() = std::nan(""); });
  refused("a normal of length 0", [](auto& bad) { bad.normal.setZero(); });
  refused("a covariance that is not finite",
          [](auto& bad) { bad.position_covariance(1, 1) = std::nan(""); });
  refused("a negative variance", [](auto& bad) { bad.position_covariance(0, 0) = -1; });
  refused("a variance of 1e296", [](auto& bad) { bad.normal_covariance *= 1e300; });
  refused("a look from before the last one", [](auto& bad) { bad.stamp = Time{} + seconds(0.5); });
}

void foreign_state_is_none(const TargetSubject& subject, LawCheck& check) {
  PluginState state;
  state.set(Foreign{});
  check.refused(subject.filter->predict(Time{}, state), "a prediction from a state of another");
  const auto estimate = subject.filter->update(Looker{}.look(3), state);
  if (!check.answered(estimate, "a look")) return;
  check.equal(estimate->measurements, 1, "the number of measurements");
}

}  // namespace

#define ARMATURE_LAW_ENTRY(Name, function, says) Law<TargetSubject>{#Name, says, &function},
std::span<const Law<TargetSubject>> target_laws() {
  static constexpr std::array kLaws{ARMATURE_TARGET_LAWS(ARMATURE_LAW_ENTRY)};
  return kLaws;
}

}  // namespace armature
