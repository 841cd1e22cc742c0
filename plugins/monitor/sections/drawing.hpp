// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "armature/robot/geometry/forbidden_zone.hpp"
#include "section.hpp"

namespace armature::monitor::sections {

/// What is drawn into a section; lengths in metres, in the image's frame.
struct Overlay {
  struct Line {
    Eigen::Vector3d from, to;
  };
  std::optional<Line> plan;    // entry and target
  std::optional<Line> needle;  // from its tip on
  std::vector<ForbiddenZone> vessels;
  std::vector<std::string> texts;  // lines in the lower left corner
};

/// The section in colours (BGR): the vessels' outlines red; the needle green and wide, with a ring
/// about its tip; on it the plan, yellow, with rings at entry and target and a cross where it meets
/// the plane of the picture. Lines that are more than 2 mm off the plane are thin, and rings are
/// full when they are not. A bar of 20 mm, and `title`.
cv::Mat drawn(const Volume& volume, const Section& section, double black, double white,
              const Overlay& overlay, const std::string& title);

}  // namespace armature::monitor::sections
