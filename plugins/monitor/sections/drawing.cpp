// SPDX-License-Identifier: Apache-2.0
#include "drawing.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace armature::monitor::sections {
namespace {

using Eigen::Vector3d;

// Okabe and Ito's colours, which colour-blind readers tell apart, as blue, green, red.
const cv::Scalar kVessel{0, 94, 213}, kPlan{66, 228, 240}, kNeedle{115, 158, 0},
    kText{255, 255, 255};
constexpr double kNear = 0.002;  // [m] as good as in the plane

/// OpenCV counts in sixteenths of a pixel when it is asked to.
constexpr int kShift = 4;
cv::Point in_sixteenths(const Vector3d& seen) {
  const auto scaled = [](double value) {
    return static_cast<int>(std::lround(std::clamp(value, -1e4, 1e4) * (1 << kShift)));
  };
  return {scaled(seen.x()), scaled(seen.y())};
}

/// How wide a line is drawn [px] where it is in the plane, and elsewhere.
struct Width {
  int near, far;
};

void draw_line(cv::Mat& picture, const Section& section, const Overlay::Line& line,
               const cv::Scalar& colour, const Width& width) {
  constexpr int kPieces = 100;
  Vector3d before = section.seen(line.from);
  for (int i = 1; i <= kPieces; ++i) {
    const Vector3d here = section.seen(line.from + (line.to - line.from) * i / kPieces);
    cv::line(picture, in_sixteenths(before), in_sixteenths(here), colour,
             std::abs(here.z()) < kNear ? width.near : width.far, cv::LINE_AA, kShift);
    before = here;
  }
}

void draw_ring(cv::Mat& picture, const Vector3d& seen, double radius_px, const cv::Scalar& colour,
               bool is_full) {
  cv::circle(picture, in_sixteenths(seen), static_cast<int>(radius_px * (1 << kShift)), colour,
             is_full ? cv::FILLED : 1, cv::LINE_AA, kShift);
}

/// Where the plane cuts vessels: their outlines.
void draw_vessels(cv::Mat& picture, const Section& section,
                  const std::vector<ForbiddenZone>& vessels) {
  for (const ForbiddenZone& vessel : vessels) {
    cv::Mat inside = cv::Mat::zeros(picture.size(), CV_8U);
    for (int v = 0; v < section.size; ++v) {
      for (int u = 0; u < section.size; ++u) {
        const Vector3d point = section.point_at(u, v);
        if (clearance(point, point, vessel) < 0) inside.at<std::uint8_t>(v, u) = 255;
      }
    }
    std::vector<std::vector<cv::Point>> outlines;
    cv::findContours(inside, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
    cv::drawContours(picture, outlines, -1, kVessel, 1, cv::LINE_AA);
  }
}

void draw_plan(cv::Mat& picture, const Section& section, const Overlay::Line& plan) {
  draw_line(picture, section, plan, kPlan, {2, 1});
  const Vector3d from = section.seen(plan.from), to = section.seen(plan.to);
  draw_ring(picture, from, 3, kPlan, false);
  draw_ring(picture, to, 3, kPlan, std::abs(to.z()) < kNear);
  if (from.z() * to.z() > 0) return;  // it stays on one side of the plane
  const Vector3d meets = from + (to - from) * from.z() / (from.z() - to.z() + 1e-12);
  for (const Vector3d& arm : {Vector3d{5, 5, 0}, Vector3d{5, -5, 0}}) {
    cv::line(picture, in_sixteenths(meets - arm), in_sixteenths(meets + arm), kPlan, 1, cv::LINE_AA,
             kShift);
  }
}

void draw_needle(cv::Mat& picture, const Section& section, const Overlay::Line& needle) {
  draw_line(picture, section, needle, kNeedle, {6, 3});  // under the plan, and wider
  const Vector3d tip = section.seen(needle.from);
  draw_ring(picture, tip, 7, kNeedle, std::abs(tip.z()) < kNear);
}

void write(cv::Mat& picture, const std::string& text, int x, int y) {
  cv::putText(picture, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, 0.4, {0, 0, 0}, 3, cv::LINE_AA);
  cv::putText(picture, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, 0.4, kText, 1, cv::LINE_AA);
}

void draw_bar(cv::Mat& picture, const Section& section) {
  const int length = static_cast<int>(std::lround(0.020 / section.pixel));
  const int right = section.size - 16, y = section.size - 12;
  cv::line(picture, {right - length, y}, {right, y}, kText, 2);
  write(picture, "20 mm", right - length - 2, y - 6);
}

}  // namespace

cv::Mat drawn(const Volume& volume, const Section& section, double black, double white,
              const Overlay& overlay, const std::string& title) {
  std::vector<std::uint8_t> grey = grey_values(volume, section, black, white);
  cv::Mat picture;
  cv::cvtColor(cv::Mat{section.size, section.size, CV_8U, grey.data()}, picture,
               cv::COLOR_GRAY2BGR);
  draw_vessels(picture, section, overlay.vessels);
  if (overlay.needle) draw_needle(picture, section, *overlay.needle);
  if (overlay.plan) draw_plan(picture, section, *overlay.plan);
  draw_bar(picture, section);
  write(picture, title, 8, 16);
  int y = section.size - 12 - 16 * (static_cast<int>(overlay.texts.size()) - 1);
  for (const std::string& text : overlay.texts) {
    write(picture, text, 8, y);
    y += 16;
  }
  return picture;
}

}  // namespace armature::monitor::sections
