// SPDX-License-Identifier: Apache-2.0
// Texts of others in a message: short, and in whole characters.
#include "armature/values/utf8.hpp"

#include <gtest/gtest.h>

#include "armature/values/inline_text.hpp"

namespace armature {
namespace {

TEST(Utf8, TheBeginningOfATextEndsWithAWholeCharacter) {
  EXPECT_EQ(beginning_of("gr\u00fcn", 4), "gr\u00fc");
  EXPECT_EQ(beginning_of("gr\u00fcn", 3), "gr") << "\u00fc has two bytes";
  EXPECT_EQ(beginning_of("gr\u00fcn", 5), "gr\u00fcn");
  EXPECT_EQ(beginning_of("\u20ac", 2), "");
  EXPECT_EQ(beginning_of("", 0), "");
}

TEST(Utf8, AMessageQuotesALongTextInPart) {
  const std::string fits(200, 'x');
  EXPECT_EQ(in_part(fits), fits);
  EXPECT_EQ(in_part(fits + "x"), fits + "...");
  EXPECT_EQ(in_part(fits.substr(1) + "\u00fc"), fits.substr(1) + "...");
}

TEST(InlineText, IsCutAtAWholeCharacter) {
  EXPECT_EQ(InlineText<8>{"12345678"}.view(), "12345678");
  EXPECT_EQ(InlineText<8>{"123456789"}.view(), "12345...");
  EXPECT_EQ(InlineText<8>{"1234\u00fc789"}.view(), "1234...") << "the fifth byte is half of one";
}

}  // namespace
}  // namespace armature
