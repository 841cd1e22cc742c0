// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reproduce/numbers.hpp"
#include "reproduce/results.hpp"

namespace armature::reproduce {

/// What is computed of a paper, from its own `numbers`. `with_long`: what takes more than a few
/// seconds, too.
using Compute = void (*)(const Numbers& numbers, bool with_long, Results& results);

struct Paper {
  const char* name;  // on the command line
  const char* file;  // its declaration
  Compute compute;
};

/// The four, in the order of the README.
const std::vector<Paper>& papers();

void compute_lamp(const Numbers& numbers, bool with_long, Results& results);
void compute_sr1(const Numbers& numbers, bool with_long, Results& results);
void compute_implant(const Numbers& numbers, bool with_long, Results& results);
void compute_master(const Numbers& numbers, bool with_long, Results& results);

}  // namespace armature::reproduce
