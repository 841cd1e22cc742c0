// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "armature/kinds/registration/registration.hpp"

namespace armature {

class Frame3 final : public Registrar {
 public:
  static Expected<std::unique_ptr<Registrar>> make(const Params& params);

  Expected<Registration> find(const MarkerPairs& markers) const override;

 private:
  explicit Frame3(double max_condition) : max_condition_{max_condition} {}

  double max_condition_;
};

}  // namespace armature
