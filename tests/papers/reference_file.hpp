// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reproduce/numbers.hpp"

namespace armature::paper {

using Figures = reproduce::Numbers;

/// tests/data/dental_lamp_reference.yaml.
Figures dental_lamp();
/// tests/data/sr1_reference.yaml.
Figures sr1();
/// tests/data/dental_implant_reference.yaml.
Figures dental_implant();

}  // namespace armature::paper
