// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/web/monitor_server.hpp"
#include "replay/publish.hpp"

namespace armature {

struct ShowOptions : PublishOptions {
  bool monitor = false;
  MonitorAddress server;
};

/// `armature replay run.mcap --monitor`: serves a recording to browsers and to Foxglove, whose
/// controls play, pause and seek in it, until --timeout or Ctrl-C. It joins no DDS domain.
int show_recording(const ShowOptions& options);

}  // namespace armature
