// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/registration/registration.hpp"
#include "registration_rigid_parameters.hpp"

namespace armature::registration::rigid {

class Rigid final : public Registrar {
 public:
  explicit Rigid(const Parameters& parameters) : parameters_{parameters} {}
  explicit Rigid(const Params& params) : Rigid{Parameters::read(params)} {}

  Expected<Registration> find(const MarkerPairs& markers) const override;

 private:
  Parameters parameters_;
};

}  // namespace armature::registration::rigid
