// SPDX-License-Identifier: Apache-2.0
// What gzip compressed comes out again: 1. whatever the size of a piece, 2. no more than was asked
// for, 3. what is damaged or ends too early is refused.
#include "armature/volume/gzip_reader.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <sstream>
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
  std::string gzip(2000 + bytes.size() / 100, '\0');
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

/// All of it, in pieces of `piece` bytes, up to `max_bytes`.
Expected<std::string> unpacked(const std::string& gzip, std::size_t max_bytes, std::size_t piece) {
  std::istringstream in{gzip};
  GzipReader reader{in};
  std::string all, bytes(piece, '\0');
  while (all.size() < max_bytes) {
    const std::size_t asked = std::min(piece, max_bytes - all.size());
    const auto count = reader.read({bytes.data(), asked});
    if (!count) return tl::unexpected{count.error()};
    all += bytes.substr(0, *count);
    if (*count < asked) break;
  }
  return all;
}

std::string refusal_of(const std::string& gzip, std::size_t piece) {
  const auto bytes = unpacked(gzip, 2000, piece);
  return bytes ? "unpacked" : bytes.error().text;
}

TEST(GzipReader, GivesTheSameInPiecesOfAnySize) {
  const std::string bytes = thousand_bytes(), gzip = compressed(bytes);
  for (const std::size_t piece : {1u, 2u, 7u, 333u, 500u, 999u, 1000u, 1001u, 5000u}) {
    const auto out = unpacked(gzip, 2000, piece);
    ASSERT_TRUE(out) << piece << ": " << out.error().text;
    EXPECT_EQ(*out, bytes) << piece;
  }
}

TEST(GzipReader, GivesNoMoreThanWasAskedForAndNothingBehindTheEnd) {
  const std::string bytes = thousand_bytes(), gzip = compressed(bytes);
  for (const std::size_t piece : {1u, 64u, 4096u}) {
    EXPECT_EQ(unpacked(gzip, 600, piece).value(), bytes.substr(0, 600)) << piece;
    EXPECT_EQ(unpacked(gzip, 4000, piece).value(), bytes) << piece;
  }
  std::istringstream in{gzip + "and more"};
  GzipReader reader{in};
  std::string piece(1000, '\0');
  EXPECT_EQ(reader.read(piece).value(), 1000U);
  EXPECT_EQ(reader.read(piece).value(), 0U);
  EXPECT_EQ(reader.read(piece).value(), 0U);
}

TEST(GzipReader, ReadsAFileThatIsLongerThanWhatItHoldsOfIt) {
  const std::string zeros(100'000'000, '\0');  // 97 kB: two pieces
  EXPECT_EQ(unpacked(compressed(zeros), 2 * zeros.size(), 1U << 20U).value(), zeros);
}

TEST(GzipReader, RefusesWhatEndsTooEarlyOrIsDamaged) {
  const std::string bytes = thousand_bytes(), gzip = compressed(bytes);
  for (const std::size_t piece : {1u, 64u, 4096u}) {
    SCOPED_TRACE(piece);
    const std::string cut = refusal_of(gzip.substr(0, gzip.size() / 2), piece);
    EXPECT_NE(cut.find(" bytes: is it truncated?"), std::string::npos) << cut;
    EXPECT_EQ(refusal_of("", piece),
              "its gzip data end within the stream, after 0 bytes: is it truncated?");
    EXPECT_EQ(refusal_of("no gzip at all", piece),
              "its gzip data are damaged after 0 bytes: incorrect header check");
    std::string other_sum = gzip;
    other_sum[gzip.size() - 6] ^= 1;
    EXPECT_EQ(refusal_of(other_sum, piece),
              "its gzip data are damaged after 1000 bytes: incorrect data check");
  }
}

}  // namespace
}  // namespace armature
