// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "armature/kinds/markers/markers.hpp"
#include "markers_spheres_parameters.hpp"

namespace armature::markers::spheres {

/// Finds balls by their surface (see README).
class Spheres final : public MarkerFinder {
 public:
  explicit Spheres(const Parameters& parameters) : parameters_{parameters} {}
  static Expected<std::unique_ptr<MarkerFinder>> make(const Params& params) {
    return std::make_unique<Spheres>(Parameters::read(params));
  }

  Expected<std::vector<FoundMarker>> find(const Volume& volume) const override;
  double marker_radius() const override { return parameters_.radius; }

 private:
  Parameters parameters_;
};

}  // namespace armature::markers::spheres
