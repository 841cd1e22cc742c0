// SPDX-License-Identifier: Apache-2.0
#include "terminal_text.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

TEST(TerminalText, ShowsWhatATerminalWouldObey) {
  EXPECT_EQ(terminal_text("bell\a \033[2J\rred"), "bell\\x07 \\x1b[2J\\x0dred");
  EXPECT_EQ(terminal_text("one\ntwo\tthree"), "one\\x0atwo\\x09three");
  EXPECT_EQ(terminal_text("\xC2\x9B"
                          "31m"),
            "\\xc2\\x9b31m")
      << "a control character of 8 bits";
  EXPECT_EQ(terminal_text("\xE2\x80\xAE"
                          "txt"),
            "\\xe2\\x80\\xaetxt")
      << "right to left";
  EXPECT_EQ(terminal_text(std::string_view{"a\0b", 3}), "a\\x00b");
}

TEST(TerminalText, LeavesTextOfAnyLanguageAsItIs) {
  const std::string text = "Einstich für Zoë, 0.3 µm: \u6cbb\u7642 \U0001F9B7";
  EXPECT_EQ(terminal_text(text), text);
}

TEST(TerminalText, ShowsBytesThatAreNoCharacter) {
  EXPECT_EQ(terminal_text("Eintritt \xFC"), "Eintritt \\xfc");
  EXPECT_EQ(terminal_text("\xE2\x82"), "\\xe2\\x82") << "cut off";
  EXPECT_EQ(terminal_text("\xC0\x8A"), "\\xc0\\x8a") << "a line end in a form that is too long";
}

TEST(TerminalText, IndentsTheLinesOfATextSoThatNoneLooksLikeAnothersWord) {
  EXPECT_EQ(terminal_lines("first\n[0.000 s] runtime: all ok\n", 4),
            "first\n    [0.000 s] runtime: all ok");
  EXPECT_EQ(terminal_lines("a\n\033[Hb", 2), "a\n  \\x1b[Hb");
  EXPECT_EQ(terminal_lines("", 2), "");
}

}  // namespace
}  // namespace armature
