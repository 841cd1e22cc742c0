// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "armature/config/problems.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/described_messages.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/values/regular_file.hpp"
#include "armature/web/dds_topics.hpp"
#include "armature/web/foxglove_bridge.hpp"
#include "armature/web/monitor_server.hpp"
#include "bridge_web_parameters.hpp"

namespace armature::bridge::web {
namespace {

/// The token of a file: its first line.
std::string token_of(const std::string& file, const Params& params) {
  if (file.empty()) return "";
  constexpr std::size_t kMaxBytes = 1U << 20U;
  const auto bytes = bytes_of_regular(file, kMaxBytes);
  if (!bytes) {
    params.refuse({"token_file"}, config::in_quotes(file) + ": " + bytes.error().text);
    return "";
  }
  std::string token = bytes->substr(0, bytes->find('\n'));
  if (token.find_first_of(" \t\r") != std::string::npos || token.empty()) {
    params.refuse({"token_file"}, "the first line of " + config::in_quotes(file) +
                                      " is no token: it is empty, or has blanks");
  }
  if (token.size() > WebServer::kMaxTokenBytes) {
    params.refuse({"token_file"},
                  fmt::format("the token of {} has {} bytes; at most {} are taken",
                              config::in_quotes(file), token.size(), WebServer::kMaxTokenBytes));
  }
  return token;
}

MonitorAddress address_of(const Parameters& parameters, const Params& params) {
  const std::string& address = parameters.address;
  if (in_addr parsed{}; inet_pton(AF_INET, address.c_str(), &parsed) != 1) {
    params.refuse({"address"}, config::in_quotes(address) +
                                   " is no IPv4 address; 127.0.0.1 is for programs of this "
                                   "machine, 0.0.0.0 for all others, too");
  }
  for (const std::string& origin : parameters.origins) {
    const std::size_t host = origin.find("://");
    if (origin.starts_with("http") && host != std::string::npos && host + 3 < origin.size() &&
        origin.find('/', host + 3) == std::string::npos) {
      continue;
    }
    params.refuse({"origins"}, config::in_quotes(origin) +
                                   " is no origin, which is a scheme and a host, with a port where "
                                   "it has one: http://localhost:8080");
  }
  MonitorAddress server{.address = address,
                        .port = parameters.port,
                        .origins = parameters.origins,
                        .token = token_of(parameters.token_file, params)};
  if (!is_loopback(address) && server.token.empty()) {
    params.refuse({"address"}, config::in_quotes(address) +
                                   " is reached by other machines, who must say a token: name a "
                                   "file that has one, token_file: monitor.token");
  }
  return server;
}

}  // namespace

/// Reads the domain as a stranger does, and serves on a thread of its own: nobody waits for it.
class WebBridgeComponent : public Component {
 public:
  explicit WebBridgeComponent(Setup& setup) : Component(setup) {
    address_ = address_of(Parameters::read(setup.params()), setup.params());
    const auto network = setup.network();
    if (!network) return;  // it is constructed and not run: the port is not its own
    lines_ = &setup.driver_thread<std::string>(kLines, [this] { serve(); });
    topics_.emplace(plugins_.emplace(), *network, [this](const auto& line) { tell(line); });
    WebServer::Options server = monitor_server(address_);
    server.origin_option = "origins:";
    try {
      bridge_.emplace(*topics_,
                      FoxgloveBridge::Options{.server = std::move(server),
                                              .on_note = [this](const auto& note) { tell(note); }});
    } catch (const std::runtime_error& error) {
      setup.params().refuse({"port", "address"}, error.what());
    }
  }

  /// Tells the operator what the serving thread has said.
  void step(Time) override {
    while (lines_) {
      const auto line = lines_->take();
      if (!line) return;
      log(line->sample);
    }
  }

 private:
  static constexpr std::size_t kLines = 16;  // that wait for the operator

  void serve() {
    // The log is on a topic, and the token is not for all who read that.
    MonitorAddress told = address_;
    if (!told.token.empty()) told.token = "...";
    std::istringstream links{monitor_links(told, bridge_->port())};
    for (std::string link; std::getline(links, link);) {
      if (link.starts_with("http")) tell(link);
    }
    for (const std::string& problem : describe_messages(*plugins_)) tell(problem);
    bridge_->run([this] { return lines_->stopping(); });
  }
  /// On the serving thread.
  void tell(const std::string& line) { lines_->push(lines_->now(), line); }

  MonitorAddress address_;
  DriverQueue<std::string>* lines_ = nullptr;  // none: it is not run
  std::optional<PluginRegistry> plugins_;
  std::optional<DdsTopics> topics_;
  std::optional<FoxgloveBridge> bridge_;
};

}  // namespace armature::bridge::web

ARMATURE_PLUGIN(armature::bridge::web::WebBridgeComponent);
