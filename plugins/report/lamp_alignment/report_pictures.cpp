// SPDX-License-Identifier: Apache-2.0
#include "report_pictures.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "armature/runtime/reporting/write_atomically.hpp"
#include "armature/values/angles.hpp"
#include "png_encoder.hpp"

namespace armature::report::lamp_alignment {
namespace {

const cv::Scalar kBlack{0, 0, 0}, kGrid{225, 225, 225}, kCurve{180, 90, 20}, kGoal{60, 60, 220};
const cv::Scalar kGreen{60, 220, 60}, kRed{40, 40, 255}, kBlue{255, 120, 40};
constexpr double kAxisLength = 0.05;  // [m]

void save(const cv::Mat& image, const std::filesystem::path& file) {
  write_atomically(file, png::encoded({.width = image.cols,
                                       .height = image.rows,
                                       .channels = image.channels(),
                                       .data = image.data,
                                       .stride = image.step}));
}

void text(cv::Mat& image, const std::string& words, cv::Point at, double scale = 0.45) {
  cv::putText(image, words, at, cv::FONT_HERSHEY_SIMPLEX, scale, kBlack, 1, cv::LINE_AA);
}

/// The nearest of 1, 2, 5 times a power of ten that makes at most `most` ticks over `range`.
double tick_step(double range, int most) {
  const double power = std::pow(10, std::floor(std::log10(range / most)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power * most >= range) return factor * power;
  }
  return 10 * power;
}

using ErrorValue = std::function<std::optional<double>(const LampError&)>;

/// One curve over time in a frame with ticks and labels. The errors span several powers of ten and
/// the goal lies at their small end, so their axis is logarithmic: from the least value, but no
/// farther than two powers of ten below the goal, to the greatest. What is less lies on the edge.
struct Panel {
  Panel(cv::Rect in, std::string what, double until_s, double limit,
        std::span<const LampError> errors, const ErrorValue& value)
      : frame{in}, title{std::move(what)}, duration_s{until_s}, goal{limit} {
    double least = goal, greatest = goal;
    for (const LampError& error : errors) {
      const auto known = value(error);
      least = std::min(least, known.value_or(least));
      greatest = std::max(greatest, known.value_or(greatest));
    }
    lowest = static_cast<int>(std::floor(std::log10(std::max({least, goal / 100, 1e-4}))));
    highest = std::max(static_cast<int>(std::ceil(std::log10(greatest))), lowest + 1);
  }

  cv::Rect frame;
  std::string title;
  double duration_s, goal;
  int lowest, highest;  // powers of ten

  cv::Point at(double time_s, double value) const {
    const double decade = std::log10(std::max(value, std::pow(10, lowest)));
    const double share = (decade - lowest) / (highest - lowest);
    const double x = frame.x + frame.width * time_s / duration_s;
    const double y = frame.y + frame.height * (1 - share);
    return {static_cast<int>(std::lround(x)), static_cast<int>(std::lround(y))};
  }

  void draw_axes(cv::Mat& image) const {
    const double bottom = std::pow(10, lowest), top = std::pow(10, highest);
    for (int power = lowest; power <= highest; ++power) {
      const double y = std::pow(10, power);
      cv::line(image, at(0, y), at(duration_s, y), kGrid);
      text(image, fmt::format("{:g}", y), at(0, y) + cv::Point{-48, 5});
    }
    const double step_x = tick_step(duration_s, 10);
    for (double x = 0; x <= duration_s * 1.0001; x += step_x) {
      cv::line(image, at(x, bottom), at(x, top), kGrid);
      text(image, fmt::format("{:g}", x), at(x, bottom) + cv::Point{-8, 18});
    }
    cv::line(image, at(0, goal), at(duration_s, goal), kGoal, 1, cv::LINE_AA);
    cv::rectangle(image, frame, kBlack);
    text(image, title, {frame.x, frame.y - 10}, 0.55);
    text(image, "time [s]", {frame.x + frame.width - 60, frame.y + frame.height + 36});
  }

  void draw_curve(cv::Mat& image, std::span<const LampError> errors,
                  const ErrorValue& value) const {
    for (std::size_t i = 1; i < errors.size(); ++i) {
      const auto from = value(errors[i - 1]), to = value(errors[i]);
      if (!from || !to) continue;
      cv::line(image, at(errors[i - 1].time_s, *from), at(errors[i].time_s, *to), kCurve, 2,
               cv::LINE_AA);
    }
  }
};

void draw_axis(cv::Mat& image, const CameraPicture& picture, const Eigen::Vector3d& from,
               const Eigen::Vector3d& axis, const cv::Scalar& color) {
  const auto pixel = [&](const Eigen::Vector3d& p) {
    return cv::Point{static_cast<int>(std::lround(picture.focal_px * p.x() / p.z() + picture.cx)),
                     static_cast<int>(std::lround(picture.focal_px * p.y() / p.z() + picture.cy))};
  };
  const Eigen::Vector3d to = from + kAxisLength * axis;
  if (from.z() < 0.01 || to.z() < 0.01) return;
  cv::arrowedLine(image, pixel(from), pixel(to), color, 2, cv::LINE_AA, 0, 0.15);
}

}  // namespace

void write_camera_picture(const CameraPicture& picture, const std::filesystem::path& file) {
  cv::Mat gray(picture.height, picture.width, CV_8UC1);
  std::copy(picture.gray.begin(), picture.gray.end(), gray.data);
  cv::Mat image;
  cv::cvtColor(gray, image, cv::COLOR_GRAY2BGR);
  for (const Eigen::Vector2d& point : picture.landmarks) {
    cv::circle(image, cv::Point2d{point.x(), point.y()}, 2, kGreen, cv::FILLED, cv::LINE_AA);
  }
  if (picture.face) {
    const auto& face = *picture.face;
    draw_axis(image, picture, face.mouth, face.across, kGreen);
    draw_axis(image, picture, face.mouth, face.normal.cross(face.across), kBlue);
    draw_axis(image, picture, face.mouth, face.normal, kRed);
  }
  save(image, file);
}

void write_error_plot(std::span<const LampError> errors, const Parameters& parameters,
                      const std::filesystem::path& file) {
  cv::Mat image(760, 1000, CV_8UC3, cv::Scalar{255, 255, 255});
  const double duration_s = errors.empty() ? 1 : std::max(1.0, errors.back().time_s);
  const auto distance_mm = [](const LampError& e) -> std::optional<double> {
    if (!e.distance_error_m) return std::nullopt;
    return 1000 * *e.distance_error_m;
  };
  const auto direction_deg = [](const LampError& e) {
    return std::optional{kDegreesPerRad * e.direction_error_rad};
  };
  const Panel distance{{70, 40, 900, 280},
                       "distance error [mm]; red: goal",
                       duration_s,
                       1000 * parameters.distance_error,
                       errors,
                       distance_mm};
  const Panel direction{{70, 415, 900, 280},
                        "direction error [deg]; red: goal",
                        duration_s,
                        kDegreesPerRad * parameters.direction_error,
                        errors,
                        direction_deg};
  distance.draw_axes(image);
  distance.draw_curve(image, errors, distance_mm);
  direction.draw_axes(image);
  direction.draw_curve(image, errors, direction_deg);
  save(image, file);
}

}  // namespace armature::report::lamp_alignment
