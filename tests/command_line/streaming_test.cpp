// SPDX-License-Identifier: Apache-2.0
// `armature fk` and `armature ik` over long files: every line answered in order, in memory that
// does not grow with their number.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "armature/values/file_content.hpp"
#include "armature/values/sanitizer.hpp"
#include "armature/values/temporary_folder.hpp"
#include "tests/command_line/lamp_robot.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Streaming : public testing::Test {
 protected:
  /// Line i asks for the first joint at i microradians: its answer shows where it belongs.
  std::string fk_lines(int count) const {
    const std::string file = folder_ / ("fk" + std::to_string(count));
    std::ofstream out{file};
    for (int i = 0; i < count; ++i) {
      out << "{\"joints\":[" << 1e-6 * i << ",0,0,0,0,0]}\n";
    }
    return file;
  }
  /// The same for `armature ik`: the tool at the height of line i.
  std::string ik_lines(int count) const {
    const std::string file = folder_ / ("ik" + std::to_string(count));
    std::ofstream out{file};
    for (int i = 0; i < count; ++i) {
      out << "{\"position_m\":[1.3,0.321," << 0.5 + 1e-6 * i << "],\"direction\":[1,0,0]}\n";
    }
    return file;
  }
  struct Run {
    int exit_code = -1;
    long peak_kib = 0;  // of resident memory
    std::string answers, talk;
  };
  /// Runs `armature ...`, standard error into `talk` or, when it is given, into `terminal`.
  Run run(std::vector<std::string> arguments, int terminal = -1) const {
    Run result;
    result.answers = folder_ / "answers";
    const std::string talk = folder_ / "talk";
    arguments.insert(arguments.begin(), armature());
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      dup2(open(result.answers.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
      dup2(terminal >= 0 ? terminal : open(talk.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600),
           STDERR_FILENO);
      execv(argv[0], argv.data());
      _exit(127);
    }
    int status = 0;
    rusage used{};
    wait4(child, &status, 0, &used);
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    result.peak_kib = used.ru_maxrss;
    if (terminal < 0) result.talk = content_of(talk);
    return result;
  }
  static std::vector<std::string> lines_of(const std::string& file) {
    std::vector<std::string> lines;
    std::ifstream in{file};
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
  }

  const TemporaryFolder folder_;
};

/// Whether what a run held at most grew with its input; a sanitizer holds back what was freed.
bool bounded(long few_kib, long many_kib) {
  constexpr long kMayGrow_kib = 1024;
  return kSanitized || many_kib - few_kib <= kMayGrow_kib;
}

TEST_F(Streaming, FkOverAHundredThousandLinesKeepsTheirOrderInBoundedMemory) {
  const Run few = run({"fk", "--robot", kLamp, fk_lines(1000)});
  const Run many = run({"fk", "--robot", kLamp, fk_lines(100000)});
  ASSERT_EQ(many.exit_code, 0);
  EXPECT_EQ(many.talk, "");  // no progress: standard error is a file
  EXPECT_TRUE(bounded(few.peak_kib, many.peak_kib)) << few.peak_kib << " " << many.peak_kib;
  const auto lines = lines_of(many.answers);
  ASSERT_EQ(lines.size(), 100000U);
  for (std::size_t i = 0; i < lines.size(); i += 997) {
    const json direction = json::parse(lines[i])["direction"];
    EXPECT_NEAR(std::atan2(direction[1].get<double>(), direction[0].get<double>()),
                1e-6 * static_cast<double>(i), 1e-9);
  }
}

TEST_F(Streaming, IkOverAHundredThousandLinesKeepsTheirOrderInBoundedMemory) {
  const std::vector<std::string> lamp{"ik", "--robot", kLamp, "--plugin", "ik/lamp_geometric"};
  auto with = [&](const std::string& file) {
    auto arguments = lamp;
    arguments.push_back(file);
    return arguments;
  };
  const Run few = run(with(ik_lines(1000)));
  const Run many = run(with(ik_lines(100000)));
  ASSERT_EQ(many.exit_code, 0);
  EXPECT_EQ(many.talk, "");
  EXPECT_TRUE(bounded(few.peak_kib, many.peak_kib)) << few.peak_kib << " " << many.peak_kib;
  const auto lines = lines_of(many.answers);
  ASSERT_EQ(lines.size(), 100000U);
  for (std::size_t i = 0; i < lines.size(); i += 997) {
    const json answer = json::parse(lines[i]);
    ASSERT_EQ(answer["status"], "ok") << lines[i];
    // z = d1 + d2 + d5 + a3 sin(q3) when it points horizontally.
    EXPECT_NEAR(0.50407 + 0.6 * std::sin(answer["solutions"][0]["joints"][2].get<double>()),
                0.5 + 1e-6 * static_cast<double>(i), 1e-9);
  }
}

TEST_F(Streaming, ProgressIsShownWhenStandardErrorIsATerminal) {
  const int ours = posix_openpt(O_RDWR | O_NOCTTY);
  ASSERT_GE(ours, 0);
  ASSERT_EQ(grantpt(ours), 0);
  ASSERT_EQ(unlockpt(ours), 0);
  const int terminal = open(ptsname(ours), O_RDWR | O_NOCTTY);
  ASSERT_GE(terminal, 0);
  // Enough lines for more than the half second that comes before the first word of progress.
  const Run many = run({"fk", "--robot", kLamp, fk_lines(400000)}, terminal);
  EXPECT_EQ(many.exit_code, 0);
  std::array<char, 65536> buffer{};
  pollfd ready{ours, POLLIN, 0};
  ASSERT_EQ(poll(&ready, 1, 1000), 1);
  const ssize_t n = read(ours, buffer.data(), buffer.size());
  close(terminal);
  close(ours);
  ASSERT_GT(n, 0);
  EXPECT_NE(std::string(buffer.data(), static_cast<std::size_t>(n)).find(" lines, "),
            std::string::npos);
  EXPECT_EQ(lines_of(many.answers).size(), 400000U);
}

}  // namespace
}  // namespace armature::test
