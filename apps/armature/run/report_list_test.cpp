// SPDX-License-Identifier: Apache-2.0
#include "run/report_list.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;

class ReportListTest : public testing::Test {
 protected:
  void put(const std::string& name, const std::string& text) const {
    std::ofstream{folder_ / name} << text;
  }
  bool has(const std::string& name) const { return fs::exists(folder_ / name); }
  std::string list() const { return content_of(folder_ / "report.sha256"); }

  const TemporaryFolder folder_;
};

TEST_F(ReportListTest, ListsWhatWasWrittenMeanwhileAsSha256sumDoes) {
  put("notes.txt", "mine");
  put("left_camera.png", "yesterday's");
  ReportList report{folder_.path()};
  report.add("arm_joints.csv");
  report.add("missing.csv");
  put("arm_joints.csv", "");
  report.add_what([&] {
    fs::remove(folder_ / "left_camera.png");
    put("left_camera.png", "today's");
    put("report.json", "abc");
    put(".hidden", "");
    fs::create_directory(folder_ / "folder");
  });
  report.write();
  EXPECT_EQ(list(),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855  arm_joints.csv\n"
            "243ccb5391176aae30362732394dc1621a5566fc003297fecc1d82b25878e8e7  left_camera.png\n"
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad  report.json\n");
}

TEST_F(ReportListTest, HasWhatWasWrittenBeforeSomethingCouldNotBe) {
  ReportList report{folder_.path()};
  EXPECT_THROW(report.add_what([&] {
    put("report.json", "abc");
    throw std::runtime_error{"the disk is full"};
  }),
               std::runtime_error);
  report.write();
  EXPECT_NE(list().find("  report.json\n"), std::string::npos);
}

TEST_F(ReportListTest, OnlyWhatItNamesIsRemovedAndOnlyAsItWasLeft) {
  const fs::path outside = folder_.path().string() + ".outside";
  std::ofstream{outside} << "abc";
  const std::string abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad  ";
  for (const char* name : {"report.json", "notes.txt", "changed.csv"}) put(name, "abc");
  fs::create_symlink(outside, folder_ / "link");
  put("report.sha256", abc + "report.json\n" + abc + "changed.csv\n" + abc + "link\n" + abc +
                           "missing.png\n" + abc + "../" + outside.filename().string() +
                           "\nno line of a list\n\n");
  put("changed.csv", "with a note of mine");
  EXPECT_EQ(remove_listed_files(folder_.path()), std::vector<std::string>{"changed.csv"});
  EXPECT_FALSE(has("report.json"));
  EXPECT_FALSE(has("report.sha256"));
  for (const char* name : {"notes.txt", "changed.csv", "link"}) EXPECT_TRUE(has(name)) << name;
  EXPECT_TRUE(fs::exists(outside)) << "the list may lead nowhere else";
  fs::remove(outside);
  EXPECT_TRUE(remove_listed_files(folder_.path()).empty()) << "there is no list any more";
  EXPECT_TRUE(has("notes.txt"));
}

}  // namespace
}  // namespace armature
