// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cstdlib>

#include "armature/config/document.hpp"
#include "tests/refusal.hpp"

namespace armature::config {
namespace {

/// All problems of a text called f.yaml, one a line; empty: it is read.
std::string problems_of(const std::string& text) {
  return test::refusal_of([&] { parse_text(text, "f.yaml"); });
}

TEST(Parsing, KeepsThePlaceOfEveryKeyAndValue) {
  const Node root = parse_text("a: 1\nb:\n  'c': [x, \"y\"]\n", "f.yaml");
  EXPECT_EQ(root.origin().text(), "f.yaml:1:1");
  EXPECT_EQ(root.entries()[1].key_origin.text(), "f.yaml:2:1");
  const Node& list = *root.find("b")->find("c");
  EXPECT_EQ(list.origin().text(), "f.yaml:3:8");
  EXPECT_EQ(list.items()[0].origin().text(), "f.yaml:3:9");
  EXPECT_EQ(list.items()[1].origin().text(), "f.yaml:3:12");
  EXPECT_FALSE(list.items()[0].quoted());
  EXPECT_TRUE(list.items()[1].quoted());
}

TEST(Parsing, CountsColumnsInCharacters) {
  const Node root = parse_text("\xEF\xBB\xBF{ä: ö, ü: 1}\r\n", "f.yaml");
  EXPECT_EQ(root.find("ü")->origin().text(), "f.yaml:1:11");
}

TEST(Parsing, ConvertsNothing) {
  const Node root = parse_text("[010, 1_000, 0x10, .nan, off, yes, 1e3]", "f.yaml");
  EXPECT_EQ(root.items()[0].text(), "010");
  EXPECT_EQ(root.items()[4].text(), "off");
}

TEST(Parsing, TellsAWrittenNullFromALeftOutValue) {
  const Node root = parse_text("a:\nb: ~\nc: null\nd: {e: , f: NULL}\n", "f.yaml");
  EXPECT_EQ(root.find("a")->kind(), Node::Kind::null);
  EXPECT_EQ(root.find("a")->text(), "");
  EXPECT_EQ(root.find("a")->origin().text(), "f.yaml:1:1") << "the place of its key";
  EXPECT_EQ(root.find("b")->text(), "~");
  EXPECT_EQ(root.find("c")->text(), "null");
  EXPECT_EQ(root.find("d")->find("e")->text(), "");
  EXPECT_EQ(root.find("d")->find("f")->text(), "NULL");
}

TEST(Parsing, ReadsAnEmptyDocumentAsNothing) {
  for (const char* text : {"", "\n", "# only a comment\n", "---\n"}) {
    EXPECT_EQ(parse_text(text, "f.yaml").describe(), "nothing") << text;
  }
}

TEST(Parsing, RefusesDuplicateKeysWithBothPlaces) {
  EXPECT_EQ(problems_of("a: 1\nb: 2\na: 3\nb: 4\n"),
            "f.yaml:3:1: 'a' is given twice; first at f.yaml:1:1\n"
            "f.yaml:4:1: 'b' is given twice; first at f.yaml:2:1");
}

TEST(Parsing, RefusesMergesAnchorsAliasesAndTags) {
  EXPECT_EQ(
      problems_of("<<: {a: 1}\n"),
      "f.yaml:1:1: '<<' merges are not read; use 'include:' at the top of the file for shared "
      "values");
  EXPECT_EQ(
      problems_of("a: &x 1\nb: *x\n"),
      "f.yaml:1:4: anchors ('&name') are not read; use 'include:', or put a text in quotes\n"
      "f.yaml:2:4: aliases ('*name') are not read; repeat the value, use 'include:', or put a "
      "text in quotes");
  EXPECT_EQ(problems_of("a: !deg 5\n"),
            "f.yaml:1:4: tags ('!deg') are not read; put a text in quotes");
}

TEST(Parsing, RefusesKeysThatAreNoText) {
  EXPECT_EQ(problems_of("[a]: 1\n"), "f.yaml:1:1: a key must be a text, not a list");
  EXPECT_EQ(problems_of("{a: 1}: 1\n"), "f.yaml:1:1: a key must be a text, not a map");
  EXPECT_EQ(problems_of("null: 1\n"), "f.yaml:1:1: a key must be a text, not nothing");
  EXPECT_EQ(problems_of("a: 1\nfoo\n"), "f.yaml:2:1: a key without ':'; write 'key: value'");
  EXPECT_EQ(problems_of("{a:b}\n"), "f.yaml:1:2: a key without ':'; write 'key: value'");
}

TEST(Parsing, RefusesASecondDocument) {
  EXPECT_EQ(problems_of("a: 1\n---\nb: 2\n"),
            "f.yaml:2:1: a second document starts here; a file holds one");
  EXPECT_EQ(problems_of("  a: 1\nb: 2\n"),
            "f.yaml:2:1: this does not belong to the document above; check its indentation");
}

TEST(Parsing, TellsThePlaceAndTheReasonOfBadSyntax) {
  EXPECT_EQ(problems_of("a: 1\n\tb: 2\n"),
            "f.yaml:2:1: cannot be read as YAML: illegal tab when looking for indentation; indent "
            "with spaces, not tabs");
  EXPECT_EQ(problems_of("a:\n\tb: 2\n"),
            "f.yaml:2:3: cannot be read as YAML: illegal map value; indent with spaces, not tabs");
  EXPECT_EQ(
      problems_of("a: b: c\n"),
      "f.yaml:1:5: cannot be read as YAML: illegal map value; check the indentation, and put a "
      "text that holds ': ' in quotes");
  EXPECT_EQ(problems_of("a: {b: 1\nc: 2\n"),
            "f.yaml:1:4: cannot be read as YAML: end of map flow not found; what opens here is not "
            "closed");
  EXPECT_EQ(
      problems_of("a: [1, 2"),
      "f.yaml:1:4: cannot be read as YAML: end of sequence flow not found; what opens here is "
      "not closed");
  EXPECT_EQ(problems_of("a: @x\n"),
            "f.yaml:1:4: cannot be read as YAML: unknown token; put a text in quotes");
}

TEST(Parsing, RefusesAQuoteThatIsNeverClosed) {
  EXPECT_EQ(problems_of("a: \"it\n"), "f.yaml:1:4: the quote that opens here is never closed");
  EXPECT_EQ(problems_of("a: 'it''s"), "f.yaml:1:4: the quote that opens here is never closed");
  EXPECT_EQ(problems_of("a: 'it''s'\nb: \"\\\"\"\n"), "");
}

TEST(Parsing, RefusesBytesThatAreNoText) {
  EXPECT_EQ(problems_of("a: 1\nb: x\xE9y\n"),
            "f.yaml:2:5: byte 0xE9 is not UTF-8; save the file as UTF-8");
  EXPECT_EQ(problems_of("\xFF\xFE"
                        "a"),
            "f.yaml:1:1: byte 0xFF is not UTF-8; save the file as UTF-8");
  EXPECT_EQ(problems_of(std::string{"a: \0b", 5}),
            "f.yaml:1:4: control character 0x00; is this a YAML file?");
  EXPECT_EQ(problems_of("a: \"\\0\"\n"), "f.yaml:1:5: an escape that makes a control character");
  EXPECT_EQ(problems_of("a: \"a\\x01b\"\n"),
            "f.yaml:1:6: an escape that makes a control character");
  EXPECT_EQ(problems_of("a: 1\rb: 2\n"),
            "f.yaml:1:5: a carriage return without a newline; save the file with Unix line ends");
}

TEST(Parsing, RefusesDeepNesting) {
  const auto repeated = [](std::string_view part) {
    std::string text;
    for (int i = 0; i < 20'000; ++i) text += part;
    return text;
  };
  EXPECT_EQ(problems_of(repeated("- ")), "f.yaml:1:201: nested deeper than 100 levels");
  EXPECT_EQ(problems_of(repeated("[")), "f.yaml:1:51: nested deeper than 100 levels");
  EXPECT_THAT(problems_of(repeated("{a: ")), testing::HasSubstr("nested deeper than 100 levels"));
  EXPECT_EQ(problems_of(std::string(100, '[') + std::string(100, ']')), "");
}

class Environment : public testing::Test {
 protected:
  void SetUp() override {
    setenv("ARMATURE_TEST_SET", "five", 1);
    setenv("ARMATURE_TEST_EMPTY", "", 1);
    unsetenv("ARMATURE_TEST_UNSET");
  }
};

TEST_F(Environment, ReplacesVariablesOutsideOfSingleQuotes) {
  const Node root = parse_text(
      "[a${ARMATURE_TEST_SET}b, \"${ARMATURE_TEST_SET}\", '${ARMATURE_TEST_SET}',\n"
      " ${ARMATURE_TEST_UNSET:-x: {y}, \"\\x24{ARMATURE_TEST_SET}\", "
      "${ARMATURE_TEST_EMPTY:-z}${ARMATURE_TEST_EMPTY}]",
      "f.yaml");
  const std::vector<std::string> expected{
      "afiveb", "five", "${ARMATURE_TEST_SET}", "x: {y", "${ARMATURE_TEST_SET}", "z"};
  ASSERT_EQ(root.items().size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(root.items()[i].text(), expected[i]);
  EXPECT_FALSE(root.items()[0].quoted());
  EXPECT_TRUE(root.items()[1].quoted());
}

TEST_F(Environment, KeepsPlacesBehindAVariable) {
  const Node root = parse_text("{a: ${ARMATURE_TEST_UNSET:-1, 2}, b: 3}", "f.yaml");
  EXPECT_EQ(root.find("a")->text(), "1, 2");
  EXPECT_EQ(root.find("b")->origin().text(), "f.yaml:1:38");
}

TEST_F(Environment, RefusesAValueThatNoFileMaySay) {
  for (const char* value : {"a\x1b[31m", "a\xff", "a\x7f"}) {
    setenv("ARMATURE_TEST_SET", value, 1);
    EXPECT_EQ(problems_of("a: ${ARMATURE_TEST_SET:-b}\n"),
              "f.yaml:1:4: the environment variable 'ARMATURE_TEST_SET' is no UTF-8, or has a "
              "control character");
  }
}

TEST_F(Environment, LeavesBlockTextAndKeysAlone) {
  const Node root = parse_text("a: |\n  ${X}, [y]\n${k}: 1\n", "f.yaml");
  EXPECT_EQ(root.find("a")->text(), "${X}, [y]\n");
  EXPECT_NE(root.find("${k}"), nullptr);
}

TEST_F(Environment, RefusesUnsetVariablesAndBadForms) {
  EXPECT_EQ(
      problems_of("a: ${ARMATURE_TEST_UNSET}\nb: ${a-b}\nc: ${\nd: ${A:-${B}}\n"),
      "f.yaml:1:4: the environment variable 'ARMATURE_TEST_UNSET' is not set; set it or write "
      "${ARMATURE_TEST_UNSET:-default}\n"
      "f.yaml:2:4: '${a-b}' is neither ${NAME} nor ${NAME:-default}; in single quotes it stays "
      "as it is written\n"
      "f.yaml:3:4: '${' is not closed by '}' on its line; in single quotes it stays as it is "
      "written\n"
      "f.yaml:4:4: '${A:-${B}' is neither ${NAME} nor ${NAME:-default}; in single quotes it "
      "stays as it is written");
}

}  // namespace
}  // namespace armature::config
