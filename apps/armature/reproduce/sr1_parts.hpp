// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reproduce/numbers.hpp"
#include "reproduce/results.hpp"

// What is computed of SR-1, part by part. `numbers`: the paper's.
namespace armature::reproduce::sr1 {

/// Forward kinematics and all branches of the reference poses.
void add_poses(const Numbers& numbers, Results& results);
/// Forward kinematics of the inverse, over random poses. Takes long.
void add_round_trips(Results& results);
/// The branch that is chosen over a whole path.
void add_choice(const Numbers& numbers, Results& results);
/// The needle's way into the head, in both tool modes.
void add_insertion(const Numbers& numbers, Results& results);
/// All registrations: on the markers of one case, as predicted, and simulated.
void add_registrations(const Numbers& numbers, bool with_long, Results& results);
/// Cubic splines through joint knots, with the two extra knots and without.
void add_splines(const Numbers& numbers, Results& results);

}  // namespace armature::reproduce::sr1
