// SPDX-License-Identifier: Apache-2.0
#include "row_file.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <fstream>

#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"
#include "tests/refusal.hpp"

namespace armature::report::joints {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;

class ReportRowFile : public testing::Test {
 protected:
  std::string refusal() const {
    return test::refusal_of([&] { RowFile{file_}; });
  }

  const TemporaryFolder folder_;
  const fs::path file_ = folder_ / "arm_joints.csv";
};

/// From here on no file of this process grows beyond `bytes`: as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_{std::signal(SIGXFSZ, SIG_IGN)} {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit little{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &little);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  void (*handler_)(int);
  rlimit before_{};
};

TEST_F(ReportRowFile, WhatWasAppendedIsThereAtOnceAndItsOwnersOnly) {
  RowFile rows{file_};
  rows.append("a,b\r\n");
  rows.append("1,2\r\n");
  EXPECT_EQ(content_of(file_), "a,b\r\n1,2\r\n") << "before anything is closed";
  struct stat status {};
  ASSERT_EQ(stat(file_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0600u);
}

TEST_F(ReportRowFile, AnOlderFileGoesWithItsPermissions) {
  std::ofstream{file_} << "of an older run";
  fs::permissions(file_, fs::perms::all);
  RowFile rows{file_};
  EXPECT_EQ(content_of(file_), "");
  EXPECT_EQ(fs::status(file_).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(ReportRowFile, ALinkIsReplacedAndNotFollowed) {
  const fs::path other = folder_ / "other";
  std::ofstream{other} << "mine";
  fs::create_symlink(other, file_);
  RowFile{file_}.append("1\r\n");
  EXPECT_EQ(content_of(other), "mine");
  EXPECT_FALSE(fs::is_symlink(file_));
  EXPECT_EQ(content_of(file_), "1\r\n");
}

TEST_F(ReportRowFile, WhatIsNoFileIsLeftAloneAndNamed) {
  fs::create_directory(file_);
  EXPECT_EQ(refusal(), "cannot write '" + file_.string() + "': it is no regular file");
  fs::remove(file_);
  ASSERT_EQ(mkfifo(file_.c_str(), 0600), 0);
  EXPECT_THAT(refusal(), EndsWith("it is no regular file"));
  EXPECT_TRUE(fs::is_fifo(file_));
}

TEST_F(ReportRowFile, AFolderThatIsNotThereIsNamed) {
  fs::remove_all(folder_.path());
  EXPECT_THAT(refusal(), AllOf(HasSubstr(file_.string()), EndsWith("No such file or directory")));
}

TEST_F(ReportRowFile, AFullDiskLeavesWholeLinesAndIsNamedWithTheFile) {
  RowFile rows{file_};
  rows.append("a,b\r\n");
  {
    const FullDisk full{8};
    rows.append("1,2\r\n");  // three bytes of it find room
    EXPECT_EQ(rows.trouble(), "cannot write '" + file_.string() + "': File too large");
  }
  rows.append("3,4\r\n");
  EXPECT_EQ(content_of(file_), "a,b\r\n") << "nothing after the line that is missing";
}

}  // namespace
}  // namespace armature::report::joints
