// SPDX-License-Identifier: Apache-2.0
#include "monitor/monitor.hpp"

#include <fmt/format.h>

#include "armature/runtime/plugins/described_messages.hpp"
#include "armature/web/dds_topics.hpp"
#include "exit_code.hpp"
#include "inspect/plugins.hpp"
#include "terminal_text.hpp"

namespace armature {

void serve_browsers(TopicSource& topics, MonitorAddress address, Playback* playback,
                    const std::function<bool()>& ends) {
  if (address.token.empty() && !is_loopback(address.address)) address.token = new_token();
  FoxgloveBridge bridge{
      topics,
      {.server = monitor_server(address),
       .on_note = [](const std::string& note) { fmt::print(stderr, "armature: {}\n", note); },
       .playback = playback}};
  tell(monitor_links(address, bridge.port()));
  bridge.run(ends);
  if (bridge.dropped() == 0) return;
  fmt::print(stderr,
             "armature: {} messages came faster than they were read, or were lost on the way\n",
             bridge.dropped());
}

int show_to_browsers(const MonitorOptions& options) {
  leave_in_order();
  PluginRegistry plugins;
  tell_warnings(plugins);
  for (const std::string& problem : describe_messages(plugins)) {
    fmt::print(stderr, "armature: {}\n", problem);
  }
  DdsTopics topics{plugins, options.network, [](const std::string& conflict) {
                     fmt::print(stderr, "armature: {}\n", terminal_text(conflict));
                   }};
  serve_browsers(topics, options.server, nullptr, left);
  return kOk;
}

}  // namespace armature
