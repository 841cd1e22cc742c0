// SPDX-License-Identifier: Apache-2.0
// For the tests: a participant of another machine, as far as its announcement can tell.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace armature {

/// Bytes of an RTPS message, little-endian.
class RtpsBytes {
 public:
  RtpsBytes& raw(const std::vector<std::uint8_t>& bytes) {
    data_.insert(data_.end(), bytes.begin(), bytes.end());
    return *this;
  }
  RtpsBytes& u16(std::uint16_t value) {
    return raw({static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8)});
  }
  RtpsBytes& u32(std::uint32_t value) {
    return u16(static_cast<std::uint16_t>(value)).u16(static_cast<std::uint16_t>(value >> 16));
  }
  RtpsBytes& parameter(std::uint16_t id, const RtpsBytes& value) {
    return u16(id).u16(static_cast<std::uint16_t>(value.data_.size())).raw(value.data_);
  }
  const std::vector<std::uint8_t>& data() const { return data_; }

 private:
  std::vector<std::uint8_t> data_;
};

/// The announcement (SPDP, RTPS 2.3 section 8.5.3) of a participant called `name` that can be
/// reached at `address` only; another `number`, another participant.
inline std::vector<std::uint8_t> spdp_announcement(const std::string& name,
                                                   const std::array<std::uint8_t, 4>& address,
                                                   std::uint8_t number = 7) {
  std::vector<std::uint8_t> prefix(12, number);
  prefix[0] = 1;
  prefix[1] = 16;  // Cyclone DDS
  const RtpsBytes locator = RtpsBytes{}
                                .u32(1)
                                .u32(7410)
                                .raw(std::vector<std::uint8_t>(12, 0))
                                .raw({address[0], address[1], address[2], address[3]});
  RtpsBytes text = RtpsBytes{}.u32(static_cast<std::uint32_t>(name.size() + 1));
  text.raw({name.begin(), name.end()}).raw(std::vector<std::uint8_t>(4 - name.size() % 4, 0));
  RtpsBytes list;
  list.raw({0, 3, 0, 0})                                              // PL_CDR_LE
      .parameter(0x15, RtpsBytes{}.raw({2, 3, 0, 0}))                 // protocol version
      .parameter(0x16, RtpsBytes{}.raw({1, 16, 0, 0}))                // vendor
      .parameter(0x50, RtpsBytes{}.raw(prefix).raw({0, 0, 1, 0xC1}))  // participant's GUID
      .parameter(0x58, RtpsBytes{}.u32(0xC3F))                        // built-in endpoints
      .parameter(0x02, RtpsBytes{}.u32(100).u32(0))                   // lease
      .parameter(0x32, locator)                                       // of discovery
      .parameter(0x31, locator)                                       // of samples
      .parameter(0x62, text)                                          // entity name
      .parameter(0x01, RtpsBytes{});
  const RtpsBytes data = RtpsBytes{}
                             .u16(0)
                             .u16(16)               // no inline QoS
                             .raw({0, 1, 0, 0xC7})  // any reader
                             .raw({0, 1, 0, 0xC2})  // the participants' writer
                             .u32(0)
                             .u32(1)  // sequence number
                             .raw(list.data());
  return RtpsBytes{}
      .raw({'R', 'T', 'P', 'S', 2, 3, 1, 16})
      .raw(prefix)
      .raw({0x15, 5})  // DATA, little-endian, with data
      .u16(static_cast<std::uint16_t>(data.data().size()))
      .raw(data.data())
      .data();
}

/// Sends it to all participants of `domain` on the loopback interface.
inline bool announce(int domain, const std::vector<std::uint8_t>& announcement) {
  const int sender = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const in_addr loopback{.s_addr = htonl(INADDR_LOOPBACK)};
  setsockopt(sender, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof loopback);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(7400 + 250 * domain));
  to.sin_addr.s_addr = inet_addr("239.255.0.1");
  const ssize_t sent = sendto(sender, announcement.data(), announcement.size(), 0,
                              reinterpret_cast<const sockaddr*>(&to), sizeof to);
  close(sender);
  return sent == static_cast<ssize_t>(announcement.size());
}

}  // namespace armature
