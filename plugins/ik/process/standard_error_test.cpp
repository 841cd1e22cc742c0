// SPDX-License-Identifier: Apache-2.0
// What a program says to a terminal that nobody reads holds up neither its answer nor its end.
#include "standard_error.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <string>

#include "program.hpp"

namespace armature::ik::process {
namespace {

/// Our standard error is a pipe that the test reads, or does not.
class PipedError {
 public:
  PipedError() : before_{dup(STDERR_FILENO)} {
    EXPECT_EQ(pipe(ends_.data()), 0);
    dup2(ends_[1], STDERR_FILENO);
    fcntl(ends_[0], F_SETFL, O_NONBLOCK);
  }
  ~PipedError() {
    dup2(before_, STDERR_FILENO);
    for (const int file : {before_, ends_[0], ends_[1]}) close(file);
  }
  PipedError(const PipedError&) = delete;
  PipedError& operator=(const PipedError&) = delete;

  void fill() const {
    fcntl(ends_[1], F_SETFL, O_NONBLOCK);
    const std::string dots(4096, '.');
    while (write(ends_[1], dots.data(), dots.size()) > 0) {
    }
    fcntl(ends_[1], F_SETFL, 0);
  }
  std::string read_all() const {
    std::string text;
    std::array<char, 65536> piece{};
    for (ssize_t n = 0; (n = read(ends_[0], piece.data(), piece.size())) > 0;) {
      text.append(piece.data(), static_cast<std::size_t>(n));
    }
    return text;
  }

 private:
  int before_;
  std::array<int, 2> ends_{};
};

std::unique_ptr<Program> talking(const std::string& script) {
  return std::move(Program::start(find_command({"sh", "-c", script}, "").value()).value());
}

TEST(StandardErrorThatNobodyReads, DropsAndCountsLines) {
  const PipedError pipe;
  StandardError errors{"solver"};
  errors.put("seen");
  EXPECT_EQ(pipe.read_all(), "solver: seen\n");
  pipe.fill();
  errors.put("one");
  errors.put(std::string(10'000, 'x'));  // three, for a pipe
  pipe.read_all();
  errors.put("seen again");
  EXPECT_EQ(pipe.read_all(),
            "solver: 4 lines were dropped: nobody has read them\nsolver: seen again\n");
}

TEST(StandardErrorThatNobodyReads, DoesNotHoldUpAnAnswer) {
  const PipedError pipe;
  pipe.fill();
  const auto program = talking(
      "read -r line; i=0; while [ $i -lt 300 ]; do echo word $i >&2; i=$((i+1)); done; "
      "echo answer; read -r line");
  EXPECT_EQ(program->ask("one", 60).value(), "answer");
}

TEST(StandardErrorThatNobodyReads, DoesNotHoldUpWhoWaitsInVain) {
  const PipedError pipe;
  pipe.fill();
  const auto program = talking("while :; do echo thinking >&2; done");
  EXPECT_EQ(program->ask("one", 0.3).error().text,
            "gave no answer within 0.3 s; its last words: thinking");
}

}  // namespace
}  // namespace armature::ik::process
