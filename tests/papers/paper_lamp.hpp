// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reproduce/lamp_example.hpp"

namespace armature::paper {

using reproduce::direction_of;
using reproduce::LampExample;

/// The lamp of configs/robots with the numbers of docs/papers/dental_lamp.yaml.
LampExample& paper_lamp();

/// Largest velocity and acceleration of any joint.
struct Peaks {
  double velocity = 0, acceleration = 0;
};
Peaks peaks_of(const Trajectory& trajectory);

}  // namespace armature::paper
