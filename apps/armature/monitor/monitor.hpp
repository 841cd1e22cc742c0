// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/web/foxglove_bridge.hpp"
#include "armature/web/monitor_server.hpp"
#include "watch/outsider.hpp"

namespace armature {

struct MonitorOptions : WatchOptions {
  MonitorAddress server;  // without a token: a new one where one is needed
};

/// `armature monitor`: shows a DDS domain in a browser, by its own page, and to Foxglove and
/// Lichtblick, until it is interrupted.
int show_to_browsers(const MonitorOptions& options);

/// Serves `topics` until `ends` is true: prints the addresses on standard output, and on standard
/// error whom it refuses and how much was dropped. Throws std::runtime_error when the port cannot
/// be had.
void serve_browsers(TopicSource& topics, MonitorAddress address, Playback* playback,
                    const std::function<bool()>& ends);

}  // namespace armature
