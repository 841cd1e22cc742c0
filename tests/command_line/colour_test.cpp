// SPDX-License-Identifier: Apache-2.0
// Colours are for people who look at a terminal: never in a file, and never against their wish.
#include <gtest/gtest.h>

#include <string>

#include "command.hpp"

namespace armature::test {
namespace {

const std::string kUnknown = armature() + " plugin info ik/nothing";

/// What `armature` prints of an error on a terminal of this sort.
std::string on_terminal(const std::string& environment) {
  return run_command(
             {"/bin/sh", "-c", "env " + environment + " script -qec '" + kUnknown + "' /dev/null"})
      .out;
}

TEST(Colour, IsShownOnATerminal) {
  EXPECT_NE(on_terminal("-u NO_COLOR TERM=xterm").find("\033[31marmature:\033[0m "),
            std::string::npos);
}

TEST(Colour, IsNotShownWhereItIsNotWanted) {
  for (const char* environment :
       {"NO_COLOR=1 TERM=xterm", "-u NO_COLOR TERM=dumb", "-u NO_COLOR -u TERM"}) {
    const std::string told = on_terminal(environment);
    EXPECT_NE(told.find("armature: "), std::string::npos) << told;
    EXPECT_EQ(told.find('\033'), std::string::npos) << environment << "\n" << told;
  }
}

TEST(Colour, IsNotShownInAFile) {
  const auto result = run_command({"/bin/sh", "-c", "env -u NO_COLOR TERM=xterm " + kUnknown});
  EXPECT_EQ(result.err.find('\033'), std::string::npos) << result.err;
}

}  // namespace
}  // namespace armature::test
