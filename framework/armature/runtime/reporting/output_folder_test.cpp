// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/reporting/output_folder.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "armature/values/temporary_folder.hpp"
#include "tests/refusal.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;

class OutputFolder : public testing::Test {
 protected:
  static std::string refusal(const fs::path& folder) {
    return test::refusal_of([&] { prepare_output_folder(folder); });
  }

  const TemporaryFolder root_;
};

TEST_F(OutputFolder, IsMadeWithWhatIsAboveItAndStaysEmpty) {
  const fs::path folder = root_ / "a" / "b";
  EXPECT_EQ(refusal(folder), "");
  EXPECT_TRUE(fs::is_empty(folder));
  EXPECT_EQ(refusal(folder), "") << "the second time";
}

TEST_F(OutputFolder, ThatIsAFileIsRefusedByName) {
  const fs::path file = root_ / "file";
  std::ofstream{file} << "mine";
  EXPECT_EQ(refusal(file), "cannot make the folder '" + file.string() + "': Not a directory");
  EXPECT_EQ(refusal(file / "below"),
            "cannot make the folder '" + (file / "below").string() + "': Not a directory");
}

TEST_F(OutputFolder, BehindALinkOfSomebodyElseIsRefusedByName) {
  const fs::path link = root_ / "link";
  fs::create_directories(root_ / "target");
  fs::create_directory_symlink(root_ / "target", link);
  EXPECT_EQ(refusal(link), "") << "a link of one's own";
  if (lchown(link.c_str(), 12345, 12345) != 0) GTEST_SKIP() << "only root gives links away";
  const std::string told = "cannot write into '" + link.string() +
                           "': it is a link of user 12345; name the folder that it leads to";
  EXPECT_EQ(refusal(link), told);
  EXPECT_EQ(refusal(link / ""), told);
  EXPECT_EQ(refusal(link / "below"), told);
  EXPECT_TRUE(fs::is_empty(root_ / "target"));
}

TEST_F(OutputFolder, ThatTakesNoFilesIsRefusedByName) {
  // Also for root, whom permissions do not hold back.
  EXPECT_EQ(refusal("/proc/self"), "cannot write into '/proc/self': No such file or directory");
}

}  // namespace
}  // namespace armature
