// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/registration/registration.hpp"
#include "registration_affine4_parameters.hpp"

namespace armature::registration::affine4 {

class Affine4 final : public Registrar {
 public:
  explicit Affine4(const Parameters& parameters) : parameters_{parameters} {}
  explicit Affine4(const Params& params) : Affine4{Parameters::read(params)} {}

  Expected<Registration> find(const MarkerPairs& markers) const override;

 private:
  Parameters parameters_;
};

}  // namespace armature::registration::affine4
