// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "armature/kinds/registration/registration.hpp"

namespace armature {

class Rigid final : public Registrar {
 public:
  static Expected<std::unique_ptr<Registrar>> make(const Params& params);

  Expected<Registration> find(const MarkerPairs& markers) const override;

 private:
  Rigid(double max_condition, double outlier_m)
      : max_condition_{max_condition}, outlier_m_{outlier_m} {}

  double max_condition_, outlier_m_;  // outlier_m_ 0: none
};

}  // namespace armature
