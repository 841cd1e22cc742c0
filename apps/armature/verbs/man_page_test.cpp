// SPDX-License-Identifier: Apache-2.0
#include "verbs/man_page.hpp"

#include <gmock/gmock.h>

namespace armature {
namespace {

using testing::HasSubstr;

TEST(ManPage, HasASectionForEveryVerbThatDoesSomething) {
  const VerbOption colour{
      .names = {"-c", "--colour"}, .type = "TEXT", .description = "of the paint", .values = 1};
  const VerbOption kind{.names = {"kind"}, .type = "TEXT", .values = 1, .required = true};
  const Verb wall{
      .name = "wall", .description = "Paint one", .options = {colour}, .positionals = {kind}};
  const Verb house{.name = "house", .description = "Paint parts", .verbs = {wall}};
  const std::string page = man_page(
      {.name = "paint", .description = "Colours things.\n\nExample: paint", .verbs = {house}},
      "1.2.3");
  EXPECT_THAT(page, testing::StartsWith(".TH PAINT 1 \"\" \"paint 1.2.3\"\n"));
  EXPECT_THAT(page, HasSubstr(".SH NAME\npaint \\- Colours things.\n"));
  EXPECT_THAT(page, HasSubstr(".SS \"paint house wall\"\nPaint one\n.PP\n"
                              ".B paint house wall\n[OPTIONS] kind\n"));
  EXPECT_THAT(page, HasSubstr(".TP\n\\fB\\-c, \\-\\-colour\\fR TEXT\nof the paint\n"));
  EXPECT_THAT(page, testing::Not(HasSubstr("Paint parts")));
}

TEST(ManPage, TakesNoTextForARequest) {
  const std::string page = man_page({.name = "x", .description = ".so /etc/passwd\n'br \\fB"}, "1");
  EXPECT_THAT(page, HasSubstr(".SH DESCRIPTION\n\\&.so /etc/passwd\n\\&'br \\efB\n"));
}

}  // namespace
}  // namespace armature
