// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "armature/messages/sensor_msgs.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::camera::v4l2 {
namespace {

ComponentHarness::Options device(const std::string& path) {
  return {.component = "{plugin: camera/v4l2, topics: left, params: {device: " + path + "}}",
          .robot = {}};
}

/// Steps until it says something is wrong.
std::string trouble(ComponentHarness& camera) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds{20};
  while (camera.status().state == StatusReporter::State::ok &&
         std::chrono::steady_clock::now() < end) {
    camera.step(1);
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
  }
  return camera.status().reason;
}

TEST(V4l2, ADeviceThatIsNotThereOrNoCameraIsNamedInTheStateAndTheRunGoesOn) {
  ComponentHarness gone{built_plugins(), device("/dev/armature-no-such-camera")};
  EXPECT_EQ(
      trouble(gone),
      "cannot open /dev/armature-no-such-camera: No such file or directory; is it plugged in?");
  ComponentHarness other{built_plugins(), device("/dev/null")};
  EXPECT_EQ(trouble(other), "/dev/null is no camera: Inappropriate ioctl for device");
  EXPECT_TRUE(other.take<msg::Image>("image").empty());
  const auto metrics = other.figures().metrics;
  EXPECT_EQ(metrics.at("pictures"), 0);
  EXPECT_EQ(metrics.at("camera_starts"), 0);
}

TEST(V4l2, NeedsADevice) {
  EXPECT_NE(refusal_of(built_plugins(), {.component = "{plugin: camera/v4l2}", .robot = {}})
                .find("device"),
            std::string::npos);
  EXPECT_NE(refusal_of(built_plugins(), device("''")).find("'device' is empty, and has no default"),
            std::string::npos);
}

}  // namespace
}  // namespace armature::camera::v4l2
