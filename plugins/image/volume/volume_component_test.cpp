// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>

#include "armature/kinds/volume_messages.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "armature/values/temporary_folder.hpp"
#include "armature/volume/nrrd.hpp"

namespace armature::image::volume {
namespace {

class VolumeComponentTest : public testing::Test {
 protected:
  ComponentHarness component() const {
    return {built_plugins(),
            {.component = "{plugin: image/volume, params: {path: " + file_.string() + "}}",
             .robot = {}}};
  }
  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "volume.nrrd";
};

TEST_F(VolumeComponentTest, AnnouncesAFileOnceAndReadersHaveItsVoxels) {
  const Volume volume{{.size = {2, 3, 4}}, std::vector<std::int16_t>(24, 7)};
  ASSERT_TRUE(write_nrrd(volume, file_));
  ComponentHarness images = component();
  images.step(0.1);
  images.step(0.2);
  const auto files = images.take<msg::VolumeFile>("volume");
  ASSERT_EQ(files.size(), 1u);
  EXPECT_EQ(files[0].header_().frame_id_(), "image");
  EXPECT_EQ(volume_of(files[0]).value().voxels, volume.voxels);
  EXPECT_FALSE(images.component().finished());
}

TEST_F(VolumeComponentTest, EndsTheRunWithTheReasonWhenAFileIsTruncated) {
  ASSERT_TRUE(write_nrrd({{.size = {2, 3, 4}}, std::vector<std::int16_t>(24, 7)}, file_));
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) - 1);
  ComponentHarness images = component();
  images.step(0.1);
  EXPECT_TRUE(images.take<msg::VolumeFile>("volume").empty());
  EXPECT_TRUE(images.component().finished());
  EXPECT_EQ(images.figures().status, "refused");
  EXPECT_NE(images.figures().reason.find("it ends after 47 of 48 bytes"), std::string::npos);
}

TEST_F(VolumeComponentTest, APathThatIsNotThereIsRefusedBeforeTheRun) {
  EXPECT_NE(refusal_of(built_plugins(),
                       {.component = "{plugin: image/volume, params: {path: /gone}}", .robot = {}})
                .find("path: there is no '/gone'; it is an NRRD file, or the folder"),
            std::string::npos);
}

}  // namespace
}  // namespace armature::image::volume
