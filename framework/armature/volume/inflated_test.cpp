// SPDX-License-Identifier: Apache-2.0
// What gzip compressed comes out again: 1. whatever the size of a piece, 2. no more than was asked
// for, nor memory for more than there can be, 3. what is damaged or ends too early is refused.
#include "armature/volume/inflated.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <string>

namespace armature {
namespace {

/// Of bytes that repeat now and then, so that matches reach over the seams of pieces.
std::string thousand_bytes() {
  std::string bytes;
  for (int i = 0; i < 1000; ++i) bytes += static_cast<char>(i % 7 == 0 ? i * i : i % 31);
  return bytes;
}

std::string compressed(const std::string& bytes) {
  std::string gzip(2000, '\0');
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(gzip.data());
  stream.avail_out = static_cast<uInt>(gzip.size());
  deflate(&stream, Z_FINISH);
  deflateEnd(&stream);
  gzip.resize(gzip.size() - stream.avail_out);
  return gzip;
}

std::string refusal_of(const std::string& gzip, std::size_t max_bytes, std::size_t piece) {
  const auto bytes = inflated(gzip, max_bytes, piece);
  return bytes ? "inflated" : bytes.error().text;
}

TEST(Inflated, IsTheSameInPiecesOfAnySize) {
  const std::string bytes = thousand_bytes(), gzip = compressed(bytes);
  for (const std::size_t piece : {1u, 2u, 7u, 333u, 500u, 999u, 1000u, 1001u, 5000u}) {
    const auto out = inflated(gzip, bytes.size(), piece);
    ASSERT_TRUE(out) << piece << ": " << out.error().text;
    EXPECT_EQ(*out, bytes) << piece;
  }
}

TEST(Inflated, GivesNoMoreThanWasAskedForAndNoMoreThanThereIs) {
  const std::string bytes = thousand_bytes(), gzip = compressed(bytes);
  for (const std::size_t piece : {1u, 64u, 4096u}) {
    EXPECT_EQ(inflated(gzip, 600, piece).value(), bytes.substr(0, 600)) << piece;
    EXPECT_EQ(inflated(gzip, 4000, piece).value(), bytes) << piece;
    EXPECT_EQ(inflated(gzip, 0, piece).value(), "") << piece;
  }
}

TEST(Inflated, TakesMemoryForWhatTheDataCanHoldAndNotForWhatIsAskedFor) {
  const std::size_t more_than_any_memory = std::size_t{1} << 60;
  const std::string bytes = thousand_bytes();
  EXPECT_EQ(inflated(compressed(bytes), more_than_any_memory).value(), bytes);
  const std::string zeros(1'000'000, '\0');  // nothing is compressed more
  EXPECT_EQ(inflated(compressed(zeros), more_than_any_memory).value(), zeros);
  EXPECT_EQ(inflated(compressed(zeros), zeros.size()).value(), zeros);
}

TEST(Inflated, ThatEndsTooEarlyOrIsDamagedIsRefused) {
  const std::string bytes = thousand_bytes(), gzip = compressed(bytes);
  for (const std::size_t piece : {1u, 64u, 4096u}) {
    SCOPED_TRACE(piece);
    const std::string cut = refusal_of(gzip.substr(0, gzip.size() / 2), 1000, piece);
    EXPECT_NE(cut.find(" bytes: is it truncated?"), std::string::npos) << cut;
    EXPECT_EQ(refusal_of("", 1000, piece),
              "its gzip data end within the stream, after 0 bytes: is it truncated?");
    EXPECT_EQ(refusal_of("no gzip at all", 1000, piece),
              "its gzip data are damaged after 0 bytes: incorrect header check");
    std::string other_sum = gzip;
    other_sum[gzip.size() - 6] ^= 1;
    EXPECT_EQ(refusal_of(other_sum, 1000, piece),
              "its gzip data are damaged after 1000 bytes: incorrect data check");
  }
}

}  // namespace
}  // namespace armature
