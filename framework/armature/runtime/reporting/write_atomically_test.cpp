// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/reporting/write_atomically.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>

#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"
#include "tests/refusal.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;

/// No file grows beyond `bytes` in its life, as on a full disk.
class LittleRoom {
 public:
  explicit LittleRoom(rlim_t bytes) : handler_{std::signal(SIGXFSZ, SIG_IGN)} {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit little{.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &little);
  }
  ~LittleRoom() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

class WriteAtomically : public testing::Test {
 protected:
  const TemporaryFolder folder_;
  const fs::path file_ = folder_ / "report.json";
};

TEST_F(WriteAtomically, ReplacesWhatWasThere) {
  write_atomically(file_, "older and longer");
  write_atomically(file_, "newer");
  EXPECT_EQ(content_of(file_), "newer");
}

TEST_F(WriteAtomically, IsReadByItsOwnerOnlyUnlessTheUserSaysOtherwise) {
  constexpr auto kOthers = fs::perms::group_all | fs::perms::others_all;
  write_atomically(file_, "a patient's");
  EXPECT_EQ(fs::status(file_).permissions() & kOthers, fs::perms::none);
  const mode_t before = umask(022);
  write_atomically(file_, "a plugin's", FileUse::named_by_user);
  umask(before);
  EXPECT_EQ(fs::status(file_).permissions() & kOthers,
            fs::perms::group_read | fs::perms::others_read);
}

TEST_F(WriteAtomically, OfAPatientIsReadByItsOwnerOnlyAndALinkKeepsPointingToIt) {
  const fs::path page = folder_ / "page.html";
  const mode_t before = umask(022);
  std::ofstream{page} << "readable by all";
  fs::create_symlink(page, file_);
  write_atomically(file_, "a patient's", FileUse::patient_file);
  umask(before);
  EXPECT_TRUE(fs::is_symlink(file_));
  EXPECT_EQ(fs::status(page).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(WriteAtomically, DoesNotFollowALink) {
  const fs::path other = folder_ / "of_somebody_else";
  std::ofstream{other} << "theirs";
  fs::create_symlink(other, file_);
  write_atomically(file_, "ours");
  EXPECT_EQ(content_of(other), "theirs");
  EXPECT_FALSE(fs::is_symlink(file_));
  EXPECT_EQ(content_of(file_), "ours");
}

TEST_F(WriteAtomically, LeavesAFileThatTheUserHasWriteProtected) {
  const std::string kept =
      "cannot write '" + file_.string() + "': it is write-protected; chmod u+w lets it be replaced";
  std::ofstream{file_} << "measured once";
  fs::permissions(file_, fs::perms::owner_read);
  EXPECT_EQ(test::refusal_of([&] { write_atomically(file_, "other", FileUse::named_by_user); }),
            kept);
  EXPECT_EQ(content_of(file_), "measured once");
  EXPECT_EQ(std::distance(fs::directory_iterator{folder_.path()}, {}), 1) << "half a file is left";
}

TEST_F(WriteAtomically, TellsOfALinkThatLeadsToItself) {
  fs::create_symlink(file_, file_);
  EXPECT_EQ(test::refusal_of([&] { write_atomically(file_, "text", FileUse::named_by_user); }),
            "cannot write '" + file_.string() + "': Too many levels of symbolic links");
}

TEST_F(WriteAtomically, IsNotHinderedByWhatARunBeforeAPowerCutHasLeft) {
  // In a container every run may have the same pid.
  const fs::path left = folder_ / ("report.json." + std::to_string(getpid()));
  std::ofstream{left} << "half of an older";
  for (const char* text : {"good", "better"}) {
    write_atomically(file_, text);
    EXPECT_EQ(content_of(file_), text);
    EXPECT_EQ(content_of(left), "half of an older") << "nobody has made it here";
  }
}

TEST_F(WriteAtomically, OnAFullDiskTellsWhyAndLeavesTheFolderAsItWas) {
  write_atomically(file_, "older");
  const LittleRoom room{1000};
  EXPECT_EQ(test::refusal_of([&] { write_atomically(file_, std::string(2000, 'x')); }),
            "cannot write '" + file_.string() + "': File too large");
  EXPECT_EQ(content_of(file_), "older");
  EXPECT_EQ(std::distance(fs::directory_iterator{folder_.path()}, {}), 1) << "half a file is left";
}

}  // namespace
}  // namespace armature
