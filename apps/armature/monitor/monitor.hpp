// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "watch/outsider.hpp"

namespace armature {

struct MonitorOptions : WatchOptions {
  std::string address = "127.0.0.1";
  int port = 8765;                   // that Foxglove asks for
  std::vector<std::string> origins;  // beside those of Foxglove and Lichtblick
  std::string token;                 // empty: a new one where one is needed
};

/// `armature monitor`: shows a DDS domain in a browser, by its own page, and to Foxglove and
/// Lichtblick, until it is interrupted.
int show_to_browsers(const MonitorOptions& options);

}  // namespace armature
