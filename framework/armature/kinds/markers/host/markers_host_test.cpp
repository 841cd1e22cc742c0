// SPDX-License-Identifier: Apache-2.0
// The host of the marker finders: 1. every volume is searched once, under its own stamp, 2. what
// cannot be searched is told with its reason.
#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>

#include "armature/kinds/markers/markers.hpp"
#include "armature/kinds/volume_messages.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "armature/values/temporary_folder.hpp"
#include "armature/volume/nrrd.hpp"

namespace armature::markers_host {
namespace {

/// One marker where the first voxel is; throws at a volume of noughts.
class FirstVoxel final : public MarkerFinder {
 public:
  Expected<std::vector<FoundMarker>> find(const Volume& volume) const override {
    if (volume.voxels[0] == 0) throw std::runtime_error{"all noughts"};
    return std::vector{FoundMarker{volume.geometry.origin, 0.005, 0.0001, 0.9}};
  }
  double marker_radius() const override { return 0.005; }
};

PluginRegistry& plugins() {
  return built_plugins_with<FirstVoxel>(
      "{armature_plugin: 1, id: markers/first_voxel, kind: markers}");
}

class MarkersHostTest : public ::testing::Test {
 protected:
  void announce(std::int16_t value, double taken_s) {
    Volume volume{{.size = {2, 2, 2}}, std::vector<std::int16_t>(8, value)};
    volume.geometry.origin = {0.1, 0.2, 0.3};
    ASSERT_TRUE(write_nrrd(volume, file_));
    msg::VolumeFile message;
    set_stamp(message.header_().stamp_(), Time{} + seconds(taken_s));
    message.path_(file_.string());
    message.sha256_(sha256_of(volume));
    host_.send("volume", message);
  }
  msg::ImageMarkers found(double now_s) {
    host_.step(now_s);
    const auto all = host_.take<msg::ImageMarkers>("markers");
    EXPECT_EQ(all.size(), 1u);
    return all.empty() ? msg::ImageMarkers{} : all.front();
  }

  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "volume.nrrd";
  ComponentHarness host_{plugins(), {.component = "{plugin: markers/first_voxel}", .robot = {}}};
};

TEST_F(MarkersHostTest, SearchesEveryVolumeOnceAndTellsItUnderTheVolumesStamp) {
  announce(7, 12.5);
  EXPECT_TRUE(host_.triggered());
  const msg::ImageMarkers markers = found(20);
  EXPECT_TRUE(markers.valid_());
  EXPECT_EQ(markers.header_().frame_id_(), "image");
  EXPECT_EQ(stamp_of(markers.header_().stamp_()), Time{} + seconds(12.5));
  ASSERT_EQ(markers.markers_().size(), 1u);
  EXPECT_LT((to_eigen(markers.markers_()[0].position_()) - Eigen::Vector3d{0.1, 0.2, 0.3}).norm(),
            1e-12);
  EXPECT_EQ(markers.markers_()[0].confidence_(), 0.9);
  host_.step(21);
  EXPECT_TRUE(host_.take<msg::ImageMarkers>("markers").empty());
  announce(8, 13);
  EXPECT_EQ(stamp_of(found(22).header_().stamp_()), Time{} + seconds(13));
}

TEST_F(MarkersHostTest, TellsWhyAVolumeCannotBeSearchedAndGoesOn) {
  announce(0, 1);
  const msg::ImageMarkers thrown = found(2);
  EXPECT_FALSE(thrown.valid_());
  EXPECT_NE(thrown.reason_().find("all noughts"), std::string::npos);
  msg::VolumeFile gone;
  gone.path_("/gone.nrrd");
  gone.sha256_("0");
  host_.send("volume", gone);
  EXPECT_EQ(found(3).reason_(), "there is no '/gone.nrrd'");
  announce(5, 4);
  EXPECT_TRUE(found(5).valid_());
}

}  // namespace
}  // namespace armature::markers_host
