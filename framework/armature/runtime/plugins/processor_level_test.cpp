// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugins/processor_level.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "armature/runtime/plugins/plugin_registry.hpp"
#include "armature/values/temporary_folder.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;

class ProcessorLevel : public testing::Test {
 protected:
  fs::path library(const std::string& name) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream{folder_ / name} << "code";
    return folder_ / name;
  }
  const TemporaryFolder folder_;
};

TEST_F(ProcessorLevel, ALibraryOfTheHighestLevelThatTheProcessorHasIsTaken) {
  const fs::path base = library("x.so"), second = library("x86-64-v2/x.so"),
                 third = library("x86-64-v3/x.so");
  EXPECT_EQ(library_for("x86-64-v4", base), third);
  EXPECT_EQ(library_for("x86-64-v3", base), third);
  EXPECT_EQ(library_for("x86-64-v2", base), second);
  EXPECT_EQ(library_for("x86_64", base), base);
  EXPECT_EQ(library_for("aarch64", base), base);
}

TEST_F(ProcessorLevel, WithoutOneTheLibraryItselfIs) {
  const fs::path base = library("x.so");
  library("x86-64-v3/y.so");
  EXPECT_EQ(library_for("x86-64-v4", base), base);
}

TEST_F(ProcessorLevel, ARegistryListsThePluginWithTheLibraryThatItWouldLoad) {
  const fs::path plugins{ARMATURE_PLUGIN_BUILD_DIR};
  const fs::path own = library_for(processor_level(), plugins / "detector_hog.so");
  if (own.parent_path() == plugins) GTEST_SKIP() << "none is built for " << processor_level();
  const PluginRegistry registry{{plugins}};
  const PluginManifest* hog = registry.find("detector/hog");
  ASSERT_NE(hog, nullptr);
  EXPECT_EQ(hog->file, own);
  EXPECT_TRUE(registry.warnings().empty());
}

}  // namespace
}  // namespace armature
