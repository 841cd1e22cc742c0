// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "armature/kinds/registration/registration.hpp"
#include "armature/kinds/registration/target_error.hpp"

// The laws that every `registration` plugin keeps. In the plugin's test, in one source file:
//
//   INSTANTIATE_TEST_SUITE_P(Rigid, RegistrationLaws, testing::Values(...));
namespace armature {

struct RegistrationSubject {
  std::string name;
  std::shared_ptr<const Registrar> registrar;
  std::size_t least;  // number of markers that it needs

  friend void PrintTo(const RegistrationSubject& subject, std::ostream* out) {
    *out << subject.name;
  }
};

class RegistrationLaws : public testing::TestWithParam<RegistrationSubject> {
 protected:
  const Registrar& registrar() const { return *GetParam().registrar; }

  /// Six markers on a head, as a surgeon places them [m]; any three span a plane, any four a body.
  static std::vector<Eigen::Vector3d> head();
  Eigen::Vector3d gauss(double sigma);
  Eigen::Isometry3d random_motion();
  static MarkerPairs seen(const Eigen::Isometry3d& robot_T_image);
  MarkerPairs with_noise(MarkerPairs markers, double marker_error_m);

  std::mt19937_64 random_{11};
  std::normal_distribution<double> normal_;
};

}  // namespace armature
