// SPDX-License-Identifier: Apache-2.0
// 1. What a declaration may say. 2. What makes a row fail. 3. What only one side knows.
#include "reproduce/judge.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "armature/config/document.hpp"
#include "reproduce/report.hpp"
#include "tests/refusal.hpp"

namespace armature::reproduce {
namespace {

using testing::HasSubstr;

/// A paper of one table with these rows and without figures.
Declaration declared(const std::string& rows) {
  return read_declaration(
      config::parse_text("paper: p\nnumbers: {}\ntables:\n  - table: t\n    title: T\n"
                         "    source: s\n    tolerance: 0.001\n    rows:\n" +
                             rows + "figures: []\n",
                         "paper.yaml"));
}

std::string problems_of(const std::string& rows) {
  return test::refusal_of([&] { declared(rows); });
}

/// Judges one row with this value of ours; its fault, or "".
std::string fault_of(const std::string& row, double ours) {
  Results results;
  results.value("t", "a", ours);
  const Judgement judgement = judge(declared("      - " + row + "\n"), results, true);
  return judgement.tables.at(0).rows.at(0).fault;
}

TEST(PaperDeclaration, OfARowThatCannotFailIsRefused) {
  EXPECT_THAT(problems_of("      - {row: a, printed: 1.5}\n"), HasSubstr("cannot fail"));
  EXPECT_THAT(problems_of("      - {row: a, printed: 1.5x, at_most: 2}\n"),
              HasSubstr("'1.5x' is no number"));
  EXPECT_THAT(problems_of("      - {row: a, at_most: 2}\n      - {row: a, at_most: 3}\n"),
              HasSubstr("in this table twice"));
  EXPECT_THAT(problems_of("      - {row: a, at_most: 2, misprint: off}\n"),
              HasSubstr("misprint without"));
  EXPECT_THAT(problems_of("      - {row: a, recomputd: 2, at_most: 1}\n"),
              HasSubstr("did you mean 'recomputed'"));
}

TEST(PaperDeclaration, KnowsTheLastDigitOfWhatIsPrinted) {
  EXPECT_DOUBLE_EQ((Printed{"1.234", 1.234}.last_digit()), 1e-3);
  EXPECT_DOUBLE_EQ((Printed{"500", 500}.last_digit()), 1);
  EXPECT_DOUBLE_EQ((Printed{"1.20e-3", 1.2e-3}.last_digit()), 1e-5);
}

TEST(PaperRow, HoldsWithinItsToleranceOfTheRecomputedValue) {
  EXPECT_EQ(fault_of("{row: a, printed: 1.23, recomputed: 1.2341}", 1.2345), "");
  EXPECT_THAT(fault_of("{row: a, printed: 1.23, recomputed: 1.2341}", 1.2361),
              HasSubstr("0.002 from the recomputed value, 0.001 allowed"));
  EXPECT_EQ(fault_of("{row: a, at_most: 2, at_least: 1}", 1.5), "");
  EXPECT_THAT(fault_of("{row: a, at_most: 2}", 2.1), HasSubstr("at most 2"));
  EXPECT_THAT(fault_of("{row: a, at_least: 2}", 1.9), HasSubstr("at least 2"));
  EXPECT_THAT(fault_of("{row: a, at_most: 2}", std::nan("")), HasSubstr("no number"));
}

TEST(PaperRow, NamesAMisprintWhereThereIsOneAndNowhereElse) {
  EXPECT_THAT(fault_of("{row: a, printed: 1.43, recomputed: 1.2341}", 1.2341),
              HasSubstr("no misprint is named"));
  EXPECT_EQ(fault_of("{row: a, printed: 1.43, recomputed: 1.2341, misprint: digits}", 1.2341), "");
  EXPECT_THAT(fault_of("{row: a, printed: 1.43, at_most: 2}", 1.2),
              HasSubstr("0.23 from the printed value"));
  EXPECT_EQ(fault_of("{row: a, printed: 1.43, at_most: 2, differs: other keys}", 1.2), "");
  EXPECT_THAT(fault_of("{row: a, printed: 1.23, recomputed: 1.2341, misprint: digits}", 1.2341),
              HasSubstr("the printed value is right"));
}

TEST(PaperRow, ThatNobodyComputesOrDeclaresFails) {
  Results results;
  results.value("t", "b", 1);
  results.curve("figure_1", 0, "c", {0, 1}, {0, 1});
  const Judgement judgement = judge(declared("      - {row: a, at_most: 2}\n"), results, true);
  EXPECT_EQ(judgement.tables.at(0).rows.at(0).fault, "not computed");
  EXPECT_THAT(judgement.faults,
              testing::ElementsAre(HasSubstr("'b' of t was computed"),
                                   HasSubstr("figure_1 was computed, and nothing declares it")));
  EXPECT_EQ(judgement.failed(), 3);
}

TEST(PaperReport, ShowsEveryRowWithItsVerdict) {
  Results results;
  results.value("t", "a", 1.2341);
  results.value("t", "b", 3);
  const Declaration declaration = declared(
      "      - {row: a, printed: 1.43, recomputed: 1.2341, misprint: digits}\n"
      "      - {row: b, at_most: 2}\n");
  const std::string text = to_text(declaration, judge(declaration, results, true));
  EXPECT_THAT(text, HasSubstr("misprint: digits"));
  EXPECT_THAT(text, HasSubstr("FAILS: at most 2"));
  EXPECT_THAT(text, HasSubstr("2 rows: 1 hold, 1 fail; 1 misprints named, 0 differ\n"));
  results.value("t", "c", 4);
  EXPECT_THAT(to_text(declaration, judge(declaration, results, true)),
              HasSubstr("2 rows: 1 hold, 1 fail; 1 misprints named, 0 differ; 1 faults\n"));
}

}  // namespace
}  // namespace armature::reproduce
