// SPDX-License-Identifier: Apache-2.0
// What the name or the address of an interface means on a machine.
#include "armature/bus/network_interface.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace armature {
namespace {

const std::vector<NetworkInterface> kMachine{
    {.name = "lo", .addresses = {"127.0.0.1"}, .up = true, .has_link = true},
    {.name = "eth0", .addresses = {"192.168.7.2", "10.0.0.5"}, .up = true, .has_link = true},
    {.name = "eth1", .addresses = {"192.168.8.2"}, .up = false, .has_link = false},
    {.name = "eth2", .addresses = {"192.168.9.2"}, .up = true, .has_link = false},
    {.name = "tap0", .up = true, .has_link = true}};

std::string joined(const std::vector<std::string>& wanted) {
  const auto found = find_interfaces(wanted, kMachine);
  return found ? to_text(*found) : "refused: " + found.error().text;
}

TEST(FindInterfaces, ANameMeansAllOfItsAddressesAndAnAddressThatOne) {
  EXPECT_EQ(joined({"eth0"}), "eth0 (192.168.7.2, 10.0.0.5)");
  EXPECT_EQ(joined({"10.0.0.5"}), "eth0 (10.0.0.5)");
}

TEST(FindInterfaces, WhatIsNamedTwiceIsJoinedOnce) {
  EXPECT_EQ(joined({"10.0.0.5", "eth0", "eth0"}), "eth0 (10.0.0.5, 192.168.7.2)");
}

TEST(FindInterfaces, LoopbackIsAlwaysJoinedAndSoNoPartOfThem) {
  EXPECT_EQ(joined({"lo", "127.0.0.1"}), "");
  EXPECT_EQ(joined({"lo", "10.0.0.5"}), "eth0 (10.0.0.5)");
}

TEST(FindInterfaces, WhatCannotBeJoinedIsRefusedWithWhatCan) {
  const std::string can = "; this machine has lo (127.0.0.1), eth0 (192.168.7.2, 10.0.0.5)";
  EXPECT_EQ(joined({"eth0", "wlan0"}), "refused: there is no interface 'wlan0'" + can);
  EXPECT_EQ(joined({"192.168.7.3"}), "refused: no interface has the address 192.168.7.3" + can);
  EXPECT_EQ(joined({"0.0.0.0"}), "refused: no interface has the address 0.0.0.0" + can);
  EXPECT_EQ(joined({"eth1"}),
            "refused: interface 'eth1' is down ('ip link set dev eth1 up')" + can);
  EXPECT_EQ(
      joined({"192.168.8.2"}),
      "refused: interface 'eth1', which has 192.168.8.2, is down ('ip link set dev eth1 up')" +
          can);
  EXPECT_EQ(joined({"eth2"}),
            "refused: interface 'eth2' has no link (is its cable plugged in?)" + can);
  EXPECT_EQ(joined({"tap0"}),
            "refused: interface 'tap0' has no IPv4 address, which DDS joins by" + can);
  const auto nothing = find_interfaces({"eth0"}, {});
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().text,
            "there is no interface 'eth0'; this machine has none with an IPv4 address that is up");
}

TEST(FindInterfaces, ATextThatIsNoneAnywhereIsRefused) {
  EXPECT_EQ(joined({""}), "refused: an interface has a name, or an IPv4 address");
  for (const std::string text : {"fe80::1", "fe80::1%eth0", "::"}) {
    EXPECT_EQ(joined({text}), "refused: '" + text +
                                  "' is an IPv6 address, and DDS joins IPv4 only; give its "
                                  "interface");
  }
  for (const std::string text :
       {"192.168.7.300", "192.168.7", "5", "192.168.7.2/24", "eth 0", "a_name_of_16_let"}) {
    EXPECT_EQ(joined({text}),
              "refused: '" + text +
                  "' is neither the name of an interface (at most 15 characters) nor an IPv4 "
                  "address (192.168.7.2)");
  }
}

TEST(NetworkInterfaces, AreThoseOfThisMachine) {
  const auto all = network_interfaces();
  const auto loopback = std::ranges::find(all, "lo", &NetworkInterface::name);
  ASSERT_NE(loopback, all.end());
  EXPECT_TRUE(loopback->up && loopback->has_link);
  EXPECT_EQ(std::ranges::count(all, "lo", &NetworkInterface::name), 1);
  EXPECT_EQ(loopback->addresses.front(), "127.0.0.1");
  for (const NetworkInterface& one : all) {
    for (const std::string& address : one.addresses) EXPECT_TRUE(is_own_address(address));
  }
}

TEST(NetworkInterfaces, OwnAddressesAreThoseOfAnInterfaceAndOfLoopback) {
  EXPECT_TRUE(is_own_address("127.0.0.9"));
  EXPECT_FALSE(is_own_address("203.0.113.7"));
}

TEST(NetworkInterfaces, TheWayToThisMachineIsLoopbackAndNoWayLeadsToNonsense) {
  EXPECT_EQ(interface_towards("127.0.0.1"), "lo");
  EXPECT_EQ(interface_towards("nowhere"), std::nullopt);
}

}  // namespace
}  // namespace armature
