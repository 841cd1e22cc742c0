// SPDX-License-Identifier: Apache-2.0
#include "replay/show.hpp"

#include <fmt/format.h>

#include "armature/values/monotonic_now.hpp"
#include "exit_code.hpp"
#include "monitor/monitor.hpp"
#include "replay/recorded_topics.hpp"
#include "terminal_text.hpp"

namespace armature {

int show_recording(const ShowOptions& options) {
  leave_in_order();
  RecordedTopics recording{options.file,
                           {.rate = static_cast<float>(options.rate),
                            .from = seconds(options.from_s),
                            .loop = options.loop}};
  for (const std::string& problem : recording.problems()) {
    fmt::print(stderr, "armature: '{}': {}\n", options.file.string(), terminal_text(problem));
  }
  const Time end = monotonic_now() + seconds(options.timeout_s);
  serve_browsers(recording, options.server, &recording,
                 [&] { return left() || (options.timeout_s > 0 && monotonic_now() > end); });
  return kOk;
}

}  // namespace armature
