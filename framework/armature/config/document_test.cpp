// SPDX-License-Identifier: Apache-2.0
#include "armature/config/document.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

#include "armature/config/params.hpp"
#include "armature/config/reader.hpp"
#include "armature/config/source_text.hpp"
#include "armature/values/temporary_folder.hpp"

namespace armature::config {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

/// An empty folder of the test's own, in which it stands.
class Documents : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "sub");
    fs::current_path(folder_.path());
  }
  void TearDown() override { fs::current_path(before_); }
  static void write(const fs::path& file, std::string_view text) { std::ofstream{file} << text; }

  static std::string merged(const std::vector<fs::path>& files,
                            const std::vector<std::string>& assignments = {}) {
    try {
      return to_yaml(load_with_overlays(files, assignments), false);
    } catch (const ConfigError& error) {
      return error.what();
    }
  }

 private:
  const TemporaryFolder folder_;
  const fs::path before_ = fs::current_path();
};

TEST_F(Documents, SayWhyAFileCannotBeRead) {
  write("a.yaml", "x: 1\ninclude: sub/missing.yaml\n");
  EXPECT_EQ(merged({"missing.yaml"}), "cannot read 'missing.yaml': No such file or directory");
  EXPECT_EQ(merged({"sub"}), "cannot read 'sub': Is a directory");
  EXPECT_EQ(merged({"clock=simulated"}),
            "cannot read 'clock=simulated': No such file or directory; is it a value? Write --set "
            "clock=simulated");
  EXPECT_EQ(merged({"a.yaml"}),
            "a.yaml:2:10: cannot read 'sub/missing.yaml': No such file or directory");
  write("list.yaml", "[1]\n");
  EXPECT_EQ(merged({"list.yaml"}), "list.yaml:1:1: a configuration file must be a map, not a list");
}

TEST_F(Documents, AreNoDevices) {
  EXPECT_EQ(merged({"/dev/zero"}), "cannot read '/dev/zero': it is a device, not a file");
  write("a.yaml", "include: /dev/tty\n");
  EXPECT_EQ(merged({"a.yaml"}), "a.yaml:1:10: cannot read '/dev/tty': it is a device, not a file");
}

TEST_F(Documents, AreReadFromAPipeThatEndsAndNotFromOneThatDoesNot) {
  ASSERT_EQ(mkfifo("pipe", 0600), 0);
  std::thread writer{[] { write("pipe", "x: 1\n"); }};
  EXPECT_EQ(merged({"pipe"}), "x: 1\n");
  writer.join();
  EXPECT_EQ(merged({"pipe"}),
            "cannot read 'pipe': it is a pipe that nobody has written to its end within 2 s");
}

TEST_F(Documents, OfOneLoadHaveTwoSecondsForAllTheirPipes) {
  ASSERT_EQ(mkfifo("a", 0600), 0);
  ASSERT_EQ(mkfifo("b", 0600), 0);
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  {
    const PipeTimeLimit one_for_all;
    for (const char* pipe : {"a", "b"}) EXPECT_THAT(merged({pipe}), HasSubstr("within 2 s"));
  }
  EXPECT_LT(Clock::now() - start, std::chrono::seconds{3});
  // Each of these is open, and says nothing for 0.7 s.
  write("main.yaml", "include: [a, a, a, a]\n");
  std::atomic<bool> ended{false};
  std::thread writer{[&] {
    while (!ended) {
      const int pipe = ::open("a", O_RDWR | O_CLOEXEC);
      std::this_thread::sleep_for(std::chrono::milliseconds{700});
      ::close(pipe);
      std::this_thread::sleep_for(std::chrono::milliseconds{50});
    }
  }};
  const auto again = Clock::now();
  EXPECT_THAT(merged({"main.yaml"}), HasSubstr("within 2 s"));
  EXPECT_LT(Clock::now() - again, std::chrono::milliseconds{2500});
  ended = true;
  writer.join();
}

TEST_F(Documents, ThatAreNoneAreNotShown) {
  write("shadow", "root:$y$j9T$secret:19000:0:99999:7:::\nuser:$y$secret:19000:0:99999:7:::\n");
  const std::string refusal =
      "shadow:1:1: this is no key of a configuration file (and is not shown here)";
  EXPECT_EQ(merged({"shadow"}), refusal);
  write("a.yaml", "include: shadow\n");
  EXPECT_EQ(merged({"a.yaml"}), refusal);
  write("passwd", "root:x:0:0:root:/root:/bin/bash\n");
  EXPECT_EQ(merged({"passwd"}), "passwd:1:1: a configuration file must be a map, not a text");
  for (const std::string text : {"secret: [\n", "secret\t: {}: x\n", "- secret\nsecret\n"}) {
    write("other", text);
    EXPECT_THAT(merged({"other"}), Not(HasSubstr("secret"))) << text;
  }
}

TEST_F(Documents, IncludeRelativeToTheIncludingFileAndOverride) {
  write("main.yaml", "include: [sub/one.yaml, sub/two.yaml]\nc: main\n");
  write("sub/one.yaml", "include: deep.yaml\na: one\nb: one\nc: one\n");
  write("sub/two.yaml", "b: two\nc: two\n");
  write("sub/deep.yaml", "a: deep\nd: deep\n");
  EXPECT_EQ(merged({"main.yaml"}), "a: one\nd: deep\nb: two\nc: main\n");
  EXPECT_EQ(load("main.yaml").find("d")->origin().text(), "sub/deep.yaml:2:4");
}

TEST_F(Documents, RefuseIncludesThatGoRoundInACircle) {
  write("a.yaml", "include: sub/b.yaml\n");
  write("sub/b.yaml", "include: ../sub/../a.yaml\n");
  EXPECT_EQ(merged({"a.yaml"}),
            "sub/b.yaml:1:10: includes go round in a circle: a.yaml -> sub/b.yaml -> a.yaml");
}

TEST_F(Documents, RefuseIncludesThatMultiply) {
  for (int i = 0; i < 20; ++i) {
    const std::string next = std::to_string(i + 1) + ".yaml";
    write(std::to_string(i) + ".yaml", "include: [" + next + ", " + next + "]\n");
  }
  write("20.yaml", "a: 1\n");
  EXPECT_THAT(merged({"0.yaml"}), testing::HasSubstr("more than 1000 files are included"));
}

TEST_F(Documents, RefuseIncludesThatAreNoPath) {
  write("a.yaml", "include: {b: c}\n");
  EXPECT_EQ(merged({"a.yaml"}),
            "a.yaml:1:10: 'include' must be a path or a list of paths, not a map");
}

TEST_F(Documents, OverlaysMergeMapsReplaceTheRestAndRemoveByNull) {
  write("a.yaml", "m: {x: 1, y: 2}\nl: [1, 2]\ngone: 5\n");
  write("b.yaml", "m: {y: 3, z: 4}\nl: [9]\ngone: null\nnew: {deep: 1}\n");
  write("empty.yaml", "# nothing\n");
  EXPECT_EQ(merged({"a.yaml", "b.yaml", "empty.yaml"}),
            "m:\n  x: 1\n  y: 3\n  z: 4\nl: [9]\nnew:\n  deep: 1\n");
}

TEST_F(Documents, OverlaysRefuseWhatWouldBeSilentlyLost) {
  write("a.yaml", "motion: {x: 1}\nparams: {a: 1}\n");
  write("b.yaml", "moton: null\nparams:\n");
  EXPECT_EQ(
      merged({"a.yaml", "b.yaml"}),
      "b.yaml:1:1: there is no 'moton' to remove; did you mean 'motion'?\n"
      "b.yaml:2:1: 'params' has no value here; leave it out to keep what stands at a.yaml:2:1, "
      "or write null to remove it");
}

TEST_F(Documents, AssignmentsReachIntoMapsAndLists) {
  write("a.yaml", "components: {ik: {plugin: ik/a}, gone: 1}\nlist: [{b: 1}, {b: 2}]\n");
  EXPECT_EQ(merged({"a.yaml"}, {"components.ik.plugin=ik/numeric", "list.1.b=[3, 4]",
                                "components.ik.params.rate_hz=5", "components.gone=null",
                                "components.ik={executor: vision}", "title=a: b", "text=\"\""}),
            "components:\n  ik:\n    plugin: ik/numeric\n    params:\n      rate_hz: 5\n"
            "    executor: vision\nlist:\n  - b: 1\n  - b: [3, 4]\ntitle:\n  a: b\ntext: \"\"\n");
  EXPECT_EQ(load_with_overlays({"a.yaml"}, {"x.y=1"}).find("x")->find("y")->origin().text(),
            "--set x.y=1");
}

TEST_F(Documents, AssignmentsThatCannotBeMadeAreErrors) {
  write("a.yaml", "arm: {plugin: arm/a}\nlist: [1]\n");
  const auto failure = [](const std::string& option) { return merged({"a.yaml"}, {option}); };
  EXPECT_EQ(failure("arm.plugin.x=1"),
            "--set arm.plugin.x=1: 'arm.plugin' is 'arm/a' (a.yaml:1:15), which has no keys");
  EXPECT_EQ(
      failure("list.1=2"),
      "--set list.1=2: 'list' is a list of 1; '1' is not one of its indices, which count from "
      "0");
  EXPECT_EQ(
      failure("list.x=2"),
      "--set list.x=2: 'list' is a list of 1; 'x' is not one of its indices, which count from "
      "0");
  EXPECT_EQ(failure("arm"), "--set arm: must be path.to.key=value");
  EXPECT_EQ(failure("arm..x=1"),
            "--set arm..x=1: the path has an empty part; it must be path.to.key=value");
  EXPECT_EQ(failure("include=b.yaml"),
            "--set include=b.yaml: 'include' stands in a file; name the other file on the command "
            "line instead");
  EXPECT_EQ(failure("=1"), "--set =1: the path has an empty part; it must be path.to.key=value");
  EXPECT_EQ(failure("arm="),
            "--set arm=: has no value; write null to remove the key, or \"\" for an empty text");
  EXPECT_EQ(failure("arm.plugn=null"),
            "--set arm.plugn=null: there is no 'plugn' to remove; did you mean 'plugin'?");
  EXPECT_EQ(failure("arm=[1"),
            "--set arm=[1: cannot be read as YAML: end of sequence flow not found; what opens here "
            "is not closed");
  EXPECT_EQ(failure("arm=${ARMATURE_TEST_NEVER_SET}"),
            "--set arm=${ARMATURE_TEST_NEVER_SET}: the environment variable "
            "'ARMATURE_TEST_NEVER_SET' is not set; set it or write "
            "${ARMATURE_TEST_NEVER_SET:-default}");
}

TEST_F(Documents, AllBadAssignmentsAreToldAtOnce) {
  EXPECT_EQ(merged({}, {"a", "b"}),
            "--set a: must be path.to.key=value\n--set b: must be path.to.key=value");
}

TEST(ToYaml, ShowsTheOriginOfEveryValue) {
  EXPECT_EQ(to_yaml(parse_text("a: {b: 1}\nl: [x, 'y']\n", "f.yaml"), true),
            "a:\n"
            "  b: 1                                          # f.yaml:1:8\n"
            "l: [x, \"y\"]                                     # f.yaml:2:4\n");
}

void expect_same(const Node& a, const Node& b) {
  ASSERT_EQ(a.kind(), b.kind());
  if (a.kind() == Node::Kind::scalar) {
    EXPECT_EQ(a.text(), b.text());
  }
  ASSERT_EQ(a.items().size(), b.items().size());
  ASSERT_EQ(a.entries().size(), b.entries().size());
  for (std::size_t i = 0; i < a.items().size(); ++i) expect_same(a.items()[i], b.items()[i]);
  for (std::size_t i = 0; i < a.entries().size(); ++i) {
    EXPECT_EQ(a.entries()[i].key, b.entries()[i].key);
    expect_same(a.entries()[i].value, b.entries()[i].value);
  }
}

constexpr const char* kSample = R"(armature: 1
name: "dental lamp"   # a comment
robots: {arm: robots/${ARMATURE_TEST_NEVER_SET:-lamp}.yaml}
clock: system
list:
- {a: -1.5e-3, b: [1, 2, [3]], c: {}}
- - nested
  - []
- ' # ${no} '
- "tab\t\"quote\" \\ é"
text: |
  two
  lines: yes
folded: >-
  one
  line
odd: [010, .nan, "null", ~, "", "- x", "a: b", "#", x#y, a:b, -x, "1", '...', ...x, =]
empty:
"quoted: key": true
)";

TEST(ToYaml, ReadsBackAsTheSameNode) {
  const Node node = parse_text(kSample, "f.yaml");
  for (const bool origins : {false, true}) {
    const std::string text = to_yaml(node, origins);
    SCOPED_TRACE(text);
    expect_same(node, parse_text(text, "g.yaml"));
  }
}

/// A few bytes changed, removed, doubled or put in.
std::string mutated(std::string text, std::mt19937& random) {
  constexpr std::string_view kAlphabet =
      "{}[]:,-#&*!|>'\"%@`~<$\\\n\t \x01\x80\xFF"
      "0aez.?=";
  const auto below = [&](std::size_t count) { return random() % count; };
  const std::size_t changes = 1 + below(8);
  for (std::size_t i = 0; i < changes && !text.empty(); ++i) {
    const std::size_t at = below(text.size());
    const std::size_t length = 1 + below(12);
    switch (below(5)) {
      case 0: text[at] = kAlphabet[below(kAlphabet.size())]; break;
      case 1: text.insert(at, 1, kAlphabet[below(kAlphabet.size())]); break;
      case 2: text.erase(at, length); break;
      case 3: text.insert(below(text.size()), text.substr(at, length)); break;
      default: text.resize(at);
    }
  }
  return text;
}

TEST(Fuzzing, AMutatedDocumentIsReadOrRefusedAndNothingElse) {
  const auto seed = std::random_device{}();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random{seed};
  int read = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::string text = mutated(kSample, random);
    SCOPED_TRACE(text);
    try {
      const Node node = parse_text(text, "f.yaml");
      expect_same(node, parse_text(to_yaml(node, true), "g.yaml"));
      Problems problems;
      MapReader map{node, "sample", problems};
      map.number("armature");
      map.optional_numbers("list");
      map.finish();
      read_param_specs(node, problems);
      merge(parse_text(kSample, "f.yaml"), node);
      ++read;
    } catch (const ConfigError& error) {
      EXPECT_FALSE(error.problems().empty());
    }
  }
  EXPECT_GT(read, 50) << "hardly any mutation leaves a document";
}

}  // namespace
}  // namespace armature::config
