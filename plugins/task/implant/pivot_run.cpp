// SPDX-License-Identifier: Apache-2.0
#include "pivot_run.hpp"

#include <fmt/format.h>

namespace armature::task::implant {

PivotRun::PivotRun(const Parameters& parameters, const std::string& tool)
    : parameters_{parameters}, watch_{tool + " in the hand", seconds(parameters.timeout)} {}

void PivotRun::begin(Time now) {
  begun_ = true;
  watch_.begin(now);
}

void PivotRun::see(const Sighting& sighting) {
  if (!begun_ && sighting.tracker_T_body) begin(sighting.stamp);
  if (!watch_.see(sighting)) return;
  if (!since_) since_ = sighting.stamp;
  poses_.push_back(*sighting.tracker_T_body);
}

bool PivotRun::complete(Time now) const {
  return since_ && now - *since_ >= seconds(parameters_.pivot);
}

std::optional<std::string> PivotRun::blind(Time now) const {
  return begun_ ? watch_.blind(now) : std::nullopt;
}

Expected<Pivot> PivotRun::result() const {
  auto pivot = calibrate_pivot(poses_);
  if (pivot && pivot->residual_rms_m > parameters_.max_pivot_rms) {
    return refuse(fmt::format("the tip stood still to {:.2f} mm rms, {:g} mm are allowed",
                              1e3 * pivot->residual_rms_m, 1e3 * parameters_.max_pivot_rms));
  }
  return pivot;
}

}  // namespace armature::task::implant
