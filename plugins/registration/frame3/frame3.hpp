// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/registration/registration.hpp"
#include "registration_frame3_parameters.hpp"

namespace armature::registration::frame3 {

class Frame3 final : public Registrar {
 public:
  explicit Frame3(const Parameters& parameters) : parameters_{parameters} {}
  explicit Frame3(const Params& params) : Frame3{Parameters::read(params)} {}

  Expected<Registration> find(const MarkerPairs& markers) const override;

 private:
  Parameters parameters_;
};

}  // namespace armature::registration::frame3
