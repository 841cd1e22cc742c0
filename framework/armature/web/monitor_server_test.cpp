// SPDX-License-Identifier: Apache-2.0
#include "armature/web/monitor_server.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <string_view>
#include <thread>

#include "armature/web/web_socket.hpp"

namespace armature {
namespace {

TEST(MonitorLinks, LeadToTheServerWhateverCharactersTheTokenHas) {
  for (const std::string token : {"plain", "x+y#z", "a&token=b", "50% /?", "\xC3\xA4"}) {
    const MonitorAddress address{.address = "127.0.0.1", .port = 0, .token = token};
    WebServer server{monitor_server(address),
                     {.opened = [](WebServer::Client, std::string_view) {},
                      .closed = [](WebServer::Client) {},
                      .woken = [] {},
                      .refused = [](const WebServer::Refusal&) {}}};
    std::atomic<bool> ends{false};
    std::thread thread{[&] {
      while (!ends) server.serve();
    }};
    const std::string links = monitor_links(address, server.port());
    const std::string query = links.substr(links.rfind("/?"));
    const std::string protocol = "Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n";
    EXPECT_TRUE(WebSocket(server.port(), protocol, query).is_open()) << links;
    EXPECT_FALSE(WebSocket(server.port(), protocol, "/?token=another").is_open());
    ends = true;
    server.wake();
    thread.join();
  }
}

TEST(MonitorLinks, OfAllAddressesAreEveryOneAndThatOfThisMachineLast) {
  const std::string links = monitor_links({.address = "0.0.0.0", .token = "t"}, 9000);
  EXPECT_EQ(links.find("0.0.0.0:"), std::string::npos) << links;
  EXPECT_TRUE(links.ends_with("http://127.0.0.1:9000/?token=t\nws://127.0.0.1:9000/?token=t"))
      << links;
}

}  // namespace
}  // namespace armature
