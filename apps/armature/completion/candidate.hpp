// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace armature {

/// What a word of the command line may become. After one that ends with '/', '.' or '=' the word
/// goes on.
struct Candidate {
  std::string text, description;
};
using Candidates = std::vector<Candidate>;

}  // namespace armature
