// SPDX-License-Identifier: Apache-2.0
// What a deployment file or an option may say of the network, and what of it this machine has.
#include "armature/bus/network.hpp"

#include <gmock/gmock.h>

namespace armature {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST(Network, OfAHostIsANameOrAnIpv4Address) {
  for (const char* good : {"desk", "theatre-2.clinic.example", "192.168.7.2", "localhost", "a_b"}) {
    EXPECT_TRUE(check_host_name(good)) << good;
  }
  for (const char* bad : {"", "192.168.7", "192.168.7.256", "a b", "desk:7400", "-desk", ".desk",
                          "fe80::1", "desk\n", "1234"}) {
    const auto checked = check_host_name(bad);
    ASSERT_FALSE(checked) << bad;
    EXPECT_THAT(checked.error().text, HasSubstr("neither the name of a host nor an IPv4 address"));
  }
  EXPECT_FALSE(check_host_name(std::string(254, 'a')));
}

TEST(Network, OfADiscoveryServerIsAHostAndAPort) {
  const auto with_port = read_server_address("192.168.7.2:7");
  ASSERT_TRUE(with_port);
  EXPECT_EQ(with_port->host, "192.168.7.2");
  EXPECT_EQ(with_port->port, 7);
  EXPECT_EQ(read_server_address("desk")->port, kDiscoveryServerPort);
  for (const char* bad : {"desk:", "desk:0", "desk:65536", "desk:-1", "desk:80x", "desk: 80"}) {
    const auto read = read_server_address(bad);
    ASSERT_FALSE(read) << bad;
    EXPECT_THAT(read.error().text, HasSubstr("is no port, from 1 to 65535")) << bad;
  }
  EXPECT_THAT(read_server_address(":80").error().text, HasSubstr("host or host:port"));
}

TEST(Network, FindsThisMachineWithoutAnyInterface) {
  const auto network = find_network({.peers = {"127.0.0.1"}, .discovery_server = "127.0.0.1:9"});
  ASSERT_TRUE(network) << network.error().text;
  EXPECT_THAT(network->peers, testing::ElementsAre("127.0.0.1"));
  EXPECT_EQ(network->server->port, 9);
  EXPECT_EQ(to_text(*network),
            "lo, and finds others through the discovery server 127.0.0.1:9, and looks for others "
            "also at 127.0.0.1");
}

TEST(Network, RefusesAPeerThatNoJoinedInterfaceLeadsTo) {
  const auto network = find_network({.peers = {"203.0.113.7"}});
  ASSERT_FALSE(network);
  EXPECT_THAT(network.error().text,
              testing::AnyOf("no way leads to the peer 203.0.113.7",
                             StartsWith("the way to the peer 203.0.113.7 leads over interface '")));
}

TEST(Network, RefusesAHostThatNobodyKnows) {
  const auto network = find_network({.peers = {"nobody.invalid"}});
  ASSERT_FALSE(network);
  EXPECT_THAT(network.error().text,
              StartsWith("host 'nobody.invalid' has no IPv4 address that is known here: "));
}

}  // namespace
}  // namespace armature
