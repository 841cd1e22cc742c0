// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace armature {

struct ReplayOptions {
  std::vector<std::filesystem::path> files;  // of one run, one for each process
  std::vector<std::string> assignments;      // --set
  bool allow_ulp = false;  // on another processor, numbers may differ in their last bits
  bool json = false;
};

/// `armature replay --check`: repeats every activation of a recorded run, and tells whether its
/// outputs are the same to the last bit, or where they differ first.
int check_recording(const ReplayOptions& options);

/// `armature replay --set ...`: repeats every activation of the components that the assignments
/// change twice, as they were recorded and as they are now, and tells what differs, by how much,
/// and how long both take.
int compare_with_recording(const ReplayOptions& options);

}  // namespace armature
