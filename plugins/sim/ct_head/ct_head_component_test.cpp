// SPDX-License-Identifier: Apache-2.0
// The tomograph on its topics: scans once, and its file is its owner's and goes with it.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "armature/kinds/volume_messages.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::sim::ct_head {
namespace {

msg::NeedlePlan told_anatomy() {
  msg::NeedlePlan plan;
  for (const Eigen::Vector3d& marker : {Eigen::Vector3d{0.09, 0, 0}, Eigen::Vector3d{0, 0.09, 0}}) {
    assign(plan.markers_().emplace_back(), marker);
  }
  assign(plan.target_(), Eigen::Vector3d{0.01, 0, 0.01});
  return plan;
}

const ComponentHarness::Options kCoarse{
    .component = "{plugin: sim/ct_head, params: {voxel_mm: [2, 2, 2]}}", .robot = {}};

TEST(CtHeadComponent, ScansTheFirstHeadOnceAndSaysWhereTheVolumeIs) {
  auto head = std::make_unique<ComponentHarness>(built_plugins(), kCoarse);
  head->step(0.1);
  EXPECT_TRUE(head->take<msg::VolumeFile>("volume").empty());
  head->send("anatomy", told_anatomy());
  EXPECT_TRUE(head->triggered());
  head->step(0.2);
  head->send("anatomy", told_anatomy());
  head->step(0.3);
  const auto files = head->take<msg::VolumeFile>("volume");
  ASSERT_EQ(files.size(), 1u);
  EXPECT_EQ(files[0].header_().frame_id_(), "image");
  const auto volume = volume_of(files[0]);
  ASSERT_TRUE(volume) << volume.error().text;
  EXPECT_NEAR(hounsfield_at(*volume, {0.09, 0, 0}), 2500, 50);
  head.reset();
  EXPECT_FALSE(std::filesystem::exists(files[0].path_()));
}

TEST(CtHeadComponent, ItsTemporaryFileIsItsOwnersAndNoLinkOfAnotherStandsInForIt) {
  namespace fs = std::filesystem;
  const auto scanned = [](const std::function<void(const fs::path&)>& look) {
    ComponentHarness head{built_plugins(), kCoarse};
    head.send("anatomy", told_anatomy());
    head.step(0.1);
    look(head.take<msg::VolumeFile>("volume").at(0).path_());
  };
  fs::path first;
  scanned([&](const fs::path& file) {
    first = file;
    EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_EQ(file.extension(), ".nrrd");
  });
  ASSERT_FALSE(fs::exists(first));
  const fs::path precious = first.string() + ".precious";
  std::ofstream{precious} << "of the user";
  fs::create_symlink(precious, first);
  scanned([&](const fs::path& file) { EXPECT_NE(file, first); });
  EXPECT_EQ(fs::file_size(precious), std::string{"of the user"}.size());
  fs::remove(first);
  fs::remove(precious);
}

TEST(CtHeadComponent, SaysWhyItHasNoTemporaryFile) {
  ComponentHarness head{built_plugins(), kCoarse};
  const char* before = std::getenv("TMPDIR");
  const std::string kept = before ? before : "";
  setenv("TMPDIR", "/nowhere", 1);
  head.send("anatomy", told_anatomy());
  head.step(0.1);
  before ? setenv("TMPDIR", kept.c_str(), 1) : unsetenv("TMPDIR");
  EXPECT_TRUE(head.take<msg::VolumeFile>("volume").empty());
  EXPECT_EQ(head.status().reason,
            "no folder for temporary files (TMPDIR): No such file or directory");
  head.send("anatomy", told_anatomy());
  head.step(0.2);
  EXPECT_EQ(head.take<msg::VolumeFile>("volume").size(), 1u);
}

TEST(CtHeadComponent, AFileThatIsWrittenToIsNotTheVolumeThatWasAnnounced) {
  ComponentHarness head{built_plugins(), kCoarse};
  head.send("anatomy", told_anatomy());
  head.step(0.1);
  auto file = head.take<msg::VolumeFile>("volume").at(0);
  file.sha256_()[0] = file.sha256_()[0] == '0' ? '1' : '0';
  EXPECT_EQ(volume_of(file).error().text,
            "'" + file.path_() + "' holds another volume than the one that was announced");
}

TEST(CtHeadComponent, SaysWhyItCannotScan) {
  ComponentHarness head{built_plugins(), kCoarse};
  msg::NeedlePlan plan = told_anatomy();
  plan.target_().x_(1);
  head.send("anatomy", plan);
  head.step(0.1);
  EXPECT_TRUE(head.take<msg::VolumeFile>("volume").empty());
  EXPECT_NE(head.status().reason.find("not within 250 mm"), std::string::npos);
}

}  // namespace
}  // namespace armature::sim::ct_head
