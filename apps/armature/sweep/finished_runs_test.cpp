// SPDX-License-Identifier: Apache-2.0
#include "sweep/finished_runs.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <fstream>
#include <stdexcept>

#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"

namespace armature::sweep {
namespace {

namespace fs = std::filesystem;

class FinishedRunsTest : public testing::Test {
 protected:
  void write(const std::string& text) const { std::ofstream{file_} << text; }
  std::string text() const { return content_of(file_); }

  const TemporaryFolder folder_;
  const fs::path file_ = folder_ / "runs.jsonl";
};

TEST_F(FinishedRunsTest, ALineThatWasCutAnywhereIsTakenAwayAndItsRunIsToBeDone) {
  {
    FinishedRuns runs{file_};
    runs.add({"abc", 1}, {{"status", "ok"}});
  }
  const std::string first = text();
  {
    FinishedRuns runs{file_};
    runs.add({"abc", 2}, {{"status", "ok"}});
  }
  const std::string second = text().substr(first.size());
  for (std::size_t bytes = 1; bytes < second.size(); ++bytes) {
    write(first + second.substr(0, bytes));
    const FinishedRuns runs{file_};
    EXPECT_TRUE(runs.find({"abc", 1})) << bytes;
    EXPECT_FALSE(runs.find({"abc", 2})) << bytes;
    EXPECT_EQ(text(), first) << bytes;
  }
}

TEST_F(FinishedRunsTest, AFileWhoseReportsAreNestedDeeplyIsOfSomethingElse) {
  const std::string deep = std::string(400'000, '[') + std::string(400'000, ']');
  const std::string line = R"({"fingerprint": "abc", "seed": 1, "report": {"a": )" + deep + "}}\n";
  write(line);
  EXPECT_THROW(FinishedRuns{file_}, std::runtime_error);
  EXPECT_EQ(text(), line);
}

TEST_F(FinishedRunsTest, AFileOfSomethingElseIsLeftAlone) {
  for (const char* other : {"important notes", "{\"fingers\": 5", "{\"finge\n"}) {
    write(other);
    EXPECT_THROW(FinishedRuns{file_}, std::runtime_error) << other;
    EXPECT_EQ(text(), other);
  }
}

}  // namespace
}  // namespace armature::sweep
