// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "watch/outsider.hpp"

namespace armature {

struct PublishOptions : WatchOptions {
  std::filesystem::path file;
  std::string prefix = "/replay";  // before the names of all topics
  double rate = 1;                 // times as fast as it was
  double from_s = 0;               // since the recording began
  bool loop = false;
};

/// `armature replay run.mcap`: publishes what was recorded again, at its own pace, under names that
/// no deployment reads: "/replay/dental_lamp/arm/measured_js". Until the end, or --timeout, or
/// Ctrl-C.
int publish_recording(const PublishOptions& options);

}  // namespace armature
