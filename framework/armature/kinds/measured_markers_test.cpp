// SPDX-License-Identifier: Apache-2.0
// Markers that somebody measured: in which frame, and with what error, they can be registered.
#include "armature/kinds/measured_markers.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "armature/messages/header.hpp"

namespace armature {
namespace {

msg::MeasuredMarkers markers_in(std::string_view frame, double error_m = 0) {
  msg::MeasuredMarkers markers;
  write_header(markers.header_(), Time{}, frame);
  markers.error_(error_m);
  return markers;
}

TEST(MeasuredMarkers, InTheirFrameAreUsableWithOrWithoutAnError) {
  EXPECT_FALSE(wrong_with(markers_in("base"), "base"));
  EXPECT_FALSE(wrong_with(markers_in("jaw", 0.0004), "jaw"));
}

TEST(MeasuredMarkers, InAnotherFrameOrInNoneAreRefusedWithItsName) {
  EXPECT_EQ(wrong_with(markers_in("camera"), "base"),
            "the markers are stated in frame 'camera', not in 'base'");
  EXPECT_EQ(wrong_with(markers_in(""), "jaw"), "the markers are stated in frame '', not in 'jaw'");
}

TEST(MeasuredMarkers, WithAnErrorThatIsNoneAreRefused) {
  EXPECT_EQ(wrong_with(markers_in("base", -0.001), "base"),
            "the error of the markers is stated as -1 mm; state how far each is expected to be "
            "off, or 0 when that is not known");
  EXPECT_TRUE(wrong_with(markers_in("base", NAN), "base"));
}

}  // namespace
}  // namespace armature
