// SPDX-License-Identifier: Apache-2.0
// The bytes of every message type are those that Fast DDS's own generator, fastddsgen 2.3.0, wrote
// for the same messages. Its SHA-256 of 200 random messages of each type stand in wire_bytes.txt.
#include <gtest/gtest.h>
#include <openssl/sha.h>

#include <fstream>
#include <string>

#include "armature/messages/known_types.hpp"
#include "armature/messages/test_messages.hpp"

namespace armature {
namespace {

std::string hexadecimal_sha256(const std::vector<std::byte>& bytes) {
  unsigned char digest[SHA256_DIGEST_LENGTH];
  SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), digest);
  std::string text;
  for (const unsigned char byte : digest) {
    text += "0123456789abcdef"[byte / 16];
    text += "0123456789abcdef"[byte % 16];
  }
  return text;
}

/// One after the other, as encoded from a message that was decoded.
std::vector<std::byte> bytes_of_200(const MessageType& type) {
  RandomCdr random{4711};
  AnyMessage any{type};
  std::vector<std::byte> bytes;
  for (int i = 0; i < 200; ++i) {
    EXPECT_TRUE(type.decode(random.of(*describe_type(type.dds_name)), any.message));
    type.encode(any.message, bytes);
  }
  return bytes;
}

TEST(WireBytes, AreThoseOfFastddsgen) {
  std::ifstream reference{ARMATURE_SOURCE_DIR "/framework/armature/messages/wire_bytes.txt"};
  std::size_t compared = 0;
  for (std::string name, digest; reference >> name >> digest; ++compared) {
    const MessageType* type = find_message_type(name);
    ASSERT_NE(type, nullptr) << name;
    EXPECT_EQ(hexadecimal_sha256(bytes_of_200(*type)), digest) << name;
  }
  EXPECT_EQ(compared, known_message_types().size());
}

}  // namespace
}  // namespace armature
