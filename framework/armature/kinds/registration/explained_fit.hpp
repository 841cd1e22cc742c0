// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "armature/kinds/registration/registration.hpp"

namespace armature ARMATURE_EXPORT {

/// How badly the best motion may fit markers of that error, rms [m]: of a million registrations at
/// most one fits worse. `marker_error_m` as `predicted_error` has it. Over the variance of one axis
/// the squares are chi-squared with 3 N - 6 degrees of freedom, as the motion takes six of the 3 N
/// to first order (their mean is the FRE^2 = (1 - 2/N) FLE^2 of Fitzpatrick, West, Maurer 1998).
/// The quantile is E. B. Wilson and M. M. Hilferty's, "The distribution of chi-square", Proceedings
/// of the National Academy of Sciences 17(12), 1931: for three markers 3.5 % too large as an rms,
/// less for more. Infinite for fewer than three.
double largest_explained_fit(std::size_t markers, double marker_error_m);

/// The error that the markers show in how the best motion fits them, where that is more than the
/// stated one: FRE / sqrt(1 - 2/N), after the same Fitzpatrick. Fewer than three show none.
double shown_marker_error(const MarkerPairs& markers, double marker_error_m);

/// The used markers, and those that lie within six times `marker_error_m` of where the map takes
/// them: a method may need three only, and leave out one that disagrees.
std::vector<bool> markers_that_agree(const Registration& found, double marker_error_m);

/// Why an error of `marker_error_m` does not explain how badly the used markers fit, or nullopt:
/// what it predicts of a target is not to be believed then. A method that does not look for the
/// best fit leaves more than that: the best motion's fit counts where it is better.
std::optional<std::string> unexplained_fit(const MarkerPairs& markers, const Registration& found,
                                           double marker_error_m);

}  // namespace armature
