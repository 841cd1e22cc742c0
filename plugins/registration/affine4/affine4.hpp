// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "armature/kinds/registration/registration.hpp"

namespace armature {

class Affine4 final : public Registrar {
 public:
  static Expected<std::unique_ptr<Registrar>> make(const Params& params);

  Expected<Registration> find(const MarkerPairs& markers) const override;

 private:
  Affine4(double max_condition, double max_stretch)
      : max_condition_{max_condition}, max_stretch_{max_stretch} {}

  double max_condition_, max_stretch_;
};

}  // namespace armature
