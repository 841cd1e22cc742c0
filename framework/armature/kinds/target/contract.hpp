// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <ostream>
#include <random>
#include <string>

#include "armature/kinds/target/target.hpp"

// The laws that every `target` plugin keeps. In the plugin's test, in one source file:
//
//   INSTANTIATE_TEST_SUITE_P(ConstantVelocity, TargetLaws, testing::Values(...));
namespace armature {

struct TargetSubject {
  std::string name;
  std::shared_ptr<const TargetFilter> filter;

  friend void PrintTo(const TargetSubject& subject, std::ostream* out) { *out << subject.name; }
};

class TargetLaws : public testing::TestWithParam<TargetSubject> {
 protected:
  const TargetFilter& filter() const { return *GetParam().filter; }

  /// A look at a still target, 1 mm and 0.02 rad of noise.
  TargetMeasurement look(double t_s);
  PluginState started();
  void expect_same_prediction(const PluginState& a, const PluginState& b);

  const Eigen::Vector3d kMouth{1.55, 0, 0.45};
  const Eigen::Vector3d kNormal{-1, 0, 0};
  std::mt19937_64 random_{1};
  std::normal_distribution<double> normal_;
};

}  // namespace armature
