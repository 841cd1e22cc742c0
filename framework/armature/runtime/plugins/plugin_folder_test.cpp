// SPDX-License-Identifier: Apache-2.0
// What others may write is not run by root, and told to everybody.
#include "armature/runtime/plugins/plugin_folder.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "armature/runtime/plugins/plugin_registry.hpp"
#include "armature/values/temporary_folder.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class PluginFolder : public testing::Test {
 protected:
  PluginFolder() {
    fs::create_directories(folder_);
    set_mode(above_.path(), 0755);
    set_mode(folder_, 0755);
    std::ofstream{folder_ / "text.so"} << "no library";
  }

  static void set_mode(const fs::path& folder, mode_t mode) { chmod(folder.c_str(), mode); }

  const TemporaryFolder above_;
  const fs::path folder_ = above_ / "plugins";
};

TEST_F(PluginFolder, OfTheUserAloneIsNoDanger) {
  EXPECT_EQ(danger_of_place(folder_), std::nullopt);
  EXPECT_EQ(danger_of_place(folder_ / "none"), std::nullopt);
}

TEST_F(PluginFolder, ThatOthersMayWriteIsOne) {
  set_mode(folder_, 0775);
  EXPECT_EQ(danger_of_place(folder_), "others may write it (mode 0775)");
  set_mode(folder_, 0757);
  EXPECT_EQ(danger_of_place(folder_), "others may write it (mode 0757)");
}

TEST_F(PluginFolder, ThatOthersMayReplaceIsOne) {
  set_mode(above_.path(), 0777);
  EXPECT_EQ(danger_of_place(folder_),
            "others may write '" + above_.path().string() + "' above it (mode 0777)");
  set_mode(above_.path(), 01777);  // sticky, as /tmp is
  EXPECT_EQ(danger_of_place(folder_), std::nullopt);
}

TEST_F(PluginFolder, ThatBelongsToSomebodyElseIsOne) {
  if (chown(folder_.c_str(), 12345, 12345) != 0) GTEST_SKIP() << "only root gives folders away";
  EXPECT_EQ(danger_of_place(folder_), "it belongs to user 12345");
}

TEST_F(PluginFolder, ThatOthersMayWriteIsToldAndNotReadByRoot) {
  set_mode(folder_, 0777);
  const PluginRegistry plugins{{folder_}};
  const bool root = geteuid() == 0;
  EXPECT_THAT(plugins.warnings(), ElementsAre(HasSubstr("plugin folder " + folder_.string() +
                                                        ": others may write it (mode 0777); ")));
  EXPECT_THAT(plugins.unusable(), SizeIs(root ? 0 : 1));
  EXPECT_THAT(plugins.unknown_text("ik/none"), HasSubstr(plugins.warnings().front()));
}

TEST_F(PluginFolder, WithAFileThatOthersMayWriteIsReadWithoutItByRoot) {
  fs::copy_file(fs::path{ARMATURE_PLUGIN_BUILD_DIR} / "transport_fast_dds.so", folder_ / "own.so");
  set_mode(folder_ / "text.so", 0666);
  const PluginRegistry plugins{{folder_}};
  EXPECT_THAT(plugins.warnings(), ElementsAre(HasSubstr("plugin " + (folder_ / "text.so").string() +
                                                        ": others may write it (mode 0666); ")));
  EXPECT_THAT(plugins.unusable(), SizeIs(geteuid() == 0 ? 0 : 1));
  EXPECT_NE(plugins.find("transport/fast_dds"), nullptr) << "the others are";
}

TEST_F(PluginFolder, WithAFileOfSomebodyElseIsReadWithoutItByRoot) {
  const fs::path file = folder_ / "text.so";
  if (chown(file.c_str(), 12345, 12345) != 0) GTEST_SKIP() << "only root gives files away";
  const PluginRegistry plugins{{folder_}};
  EXPECT_THAT(plugins.warnings(),
              ElementsAre("plugin " + file.string() +
                          ": it belongs to user 12345; root does not load it: make it root's own, "
                          "and writable by root only"));
  EXPECT_THAT(plugins.unusable(), IsEmpty());
}

TEST_F(PluginFolder, WithALinkIsAsGoodAsWhatItLeadsTo) {
  const fs::path elsewhere = above_ / "elsewhere";
  fs::create_directories(elsewhere);
  fs::rename(folder_ / "text.so", elsewhere / "text.so");
  fs::create_symlink(elsewhere / "text.so", folder_ / "link.so");
  set_mode(elsewhere, 0755);
  EXPECT_THAT(PluginRegistry({folder_}).warnings(), IsEmpty());
  set_mode(elsewhere, 0777);
  const std::string link = "plugin " + (folder_ / "link.so").string() + ", a link to " +
                           (elsewhere / "text.so").string() + ": ";
  EXPECT_THAT(PluginRegistry({folder_}).warnings(),
              ElementsAre(HasSubstr(link + "others may write '" + elsewhere.string() +
                                    "' above it (mode 0777); ")));
  set_mode(elsewhere, 0755);
  set_mode(elsewhere / "text.so", 0646);
  EXPECT_THAT(PluginRegistry({folder_}).warnings(),
              ElementsAre(HasSubstr(link + "others may write it (mode 0646); ")));
}

TEST_F(PluginFolder, ThatIsNamedTwiceShadowsNothing) {
  const fs::path own = ARMATURE_PLUGIN_BUILD_DIR;
  EXPECT_THAT(PluginRegistry({own, own}).warnings(), IsEmpty());
}

TEST_F(PluginFolder, WithAPluginThatIsThereAlreadyIsToldWithBothPaths) {
  const fs::path own = fs::path{ARMATURE_PLUGIN_BUILD_DIR} / "transport_fast_dds.so";
  fs::copy_file(own, folder_ / "mine.so");
  const PluginRegistry plugins{{folder_, own.parent_path()}};
  EXPECT_EQ(plugins.find("transport/fast_dds")->file, folder_ / "mine.so");
  EXPECT_THAT(
      plugins.warnings(),
      ElementsAre("plugin " + own.string() +
                  " is not used: 'transport/fast_dds' is already provided by " +
                  (folder_ / "mine.so").string() + ", which comes earlier in the search path"));
}

}  // namespace
}  // namespace armature
