// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "armature/kinds/registration/marker_matching.hpp"
#include "armature/kinds/registration/registration.hpp"

namespace armature ARMATURE_EXPORT {

/// Why markers with an error of `marker_error_m` (as `predicted_error` has it) do not tell whether
/// the images show the head mirrored, or nullopt where they do. Those that the map used are asked,
/// then those with whatever else lies within six times that error of where the map takes it: they
/// tell where the error explains how a motion fits them (`largest_explained_fit`), and not how a
/// reflection does. Three markers never tell, nor do others near one plane. Allocates.
std::optional<std::string> unchecked_handedness(const MarkerPairs& markers,
                                                const Registration& found, double marker_error_m);

/// The same of markers that were measured in any order: those that lie alike on both sides of a
/// plane fit their mirror image exchanged, however much of a body they span.
std::optional<std::string> exchangeable_handedness(const MarkerMatch& match, double marker_error_m);

}  // namespace armature
