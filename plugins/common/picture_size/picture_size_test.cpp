// SPDX-License-Identifier: Apache-2.0
// 1. Every format that is read tells how large its picture is before that is unpacked. 2. Other
// files, and beginnings that are cut or tell nothing, are refused.
#include "picture_size.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <string_view>

namespace armature::pictures {
namespace {

using namespace std::string_view_literals;

std::span<const std::uint8_t> as_bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

struct Beginning {
  std::string_view format, bytes;
};

/// Of pictures of 300 columns and 20 rows.
constexpr Beginning kBeginnings[] = {
    {"PNG", "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\1\x2c\0\0\0\x14"sv},
    {"BMP", "BM\0\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x2c\1\0\0\x14\0\0\0"sv},
    {"BMP that goes downwards",
     "BM\0\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x2c\1\0\0\xec\xff\xff\xff"sv},
    {"BMP of OS/2", "BM\0\0\0\0\0\0\0\0\x1a\0\0\0\x0c\0\0\0\x2c\1\x14\0"sv},
    {"TIFF", "II*\0\x08\0\0\0\2\0\0\1\4\0\1\0\0\0\x2c\1\0\0\1\1\3\0\1\0\0\0\x14\0\0\0"sv},
    {"TIFF of big bytes first",
     "MM\0*\0\0\0\x08\0\2\1\0\0\4\0\0\0\1\0\0\1\x2c\1\1\0\3\0\0\0\1\0\x14\0\0"sv},
    {"PGM", "P5\n300 20\n"sv},
    {"PPM", "P6 # of a camera\n# 640 480\n300\n20 "sv},
    {"PPM with lines of an old Macintosh", "P6\r# 640 480\r300 20\r255\r"sv},
};

TEST(ToldSize, IsThatOfTheBeginningInEveryFormat) {
  for (const auto& [format, bytes] : kBeginnings) {
    SCOPED_TRACE(format);
    const auto size = told_size(as_bytes(bytes));
    ASSERT_TRUE(size) << size.error().text;
    EXPECT_EQ(size->width, 300);
    EXPECT_EQ(size->height, 20);
  }
}

TEST(ToldSize, OfABeginningThatIsCutIsNeverAnotherOne) {
  for (const auto& [format, bytes] : kBeginnings) {
    if (format.starts_with("PGM") || format.starts_with("PPM"))
      continue;  // their numbers end where they are cut
    for (std::size_t count = 0; count < bytes.size() - 4; ++count) {
      EXPECT_FALSE(told_size(as_bytes(bytes.substr(0, count)))) << format << ", " << count;
    }
  }
}

TEST(ToldSize, IsRefusedOfAnotherFileAndOfOneThatDoesNotSayIt) {
  for (const std::string_view other :
       {""sv, "no picture"sv, "RIFF\x1e\0\0\0WEBPVP8X"sv, "GIF89a\0\1\0\1"sv, "P7\nWIDTH 3\n"sv,
        "Pf\n30 30\n-1.0\n"sv, "II+\0\x08\0\0\0"sv, "#?RADIANCE\n"sv}) {
    const auto size = told_size(as_bytes(other));
    ASSERT_FALSE(size) << other;
    EXPECT_EQ(size.error().text, "it is none of PNG, JPEG, PGM, PPM, BMP and TIFF");
  }
  for (const std::string_view silent :
       {"P5\nwidth"sv, "BM"sv, "MM\0*\0\0\0\x08\0\0"sv,
        "II*\0\x08\0\0\0\1\0\0\1\x0c\0\1\0\0\0\x2c\1\0\0"sv, "II*\0\xff\xff\xff\xff"sv}) {
    const auto size = told_size(as_bytes(silent));
    ASSERT_FALSE(size) << silent;
    EXPECT_EQ(size.error().text, "its beginning does not say how many pixels it has");
  }
}

TEST(ToldSize, OfAnyBytesIsASizeOrARefusal) {
  const auto seed = std::random_device{}();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random{seed};
  for (int i = 0; i < 20'000; ++i) {
    std::string bytes{kBeginnings[random() % std::size(kBeginnings)].bytes};
    for (int changes = 0; changes < 3; ++changes) {
      bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    const auto size = told_size(as_bytes(bytes));
    if (!size) continue;
    EXPECT_TRUE(size->width >= 0 && size->height >= 0);
  }
}

TEST(PictureSize, IsRefusedWhenAPictureWouldTakeTooMuchMemory) {
  EXPECT_TRUE(check_size({10'000, 10'000}));
  EXPECT_TRUE(check_size({16'384, 6'000}));
  EXPECT_EQ(check_size({16'385, 1}).error().text, "it has 16385 x 1 pixels; a side may have 16384");
  EXPECT_EQ(check_size({1, 2'147'483'648}).error().text,
            "it has 1 x 2147483648 pixels; a side may have 16384");
  EXPECT_EQ(check_size({16'384, 16'384}).error().text,
            "it has 16384 x 16384 pixels; a picture may have 100 million");
}

}  // namespace
}  // namespace armature::pictures
