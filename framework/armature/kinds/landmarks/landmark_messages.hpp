// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

#include "armature/kinds/landmarks/landmarks.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {
namespace detail {

inline std::array<double, 4> box_of(const PixelBox& box) {
  return {box.left, box.top, box.width, box.height};
}

inline void write_points(const FaceLandmarks& face, std::vector<double>& points,
                         std::vector<double>& sigmas) {
  points.clear();
  sigmas.clear();
  for (const Landmark& landmark : face.points) {
    points.insert(points.end(), {landmark.point.x(), landmark.point.y()});
    sigmas.push_back(landmark.sigma);
  }
}

inline Expected<FaceLandmarks> face_of(LandmarkScheme scheme, const std::vector<double>& points,
                                       const std::vector<double>& sigmas, const auto& box) {
  const std::size_t count = landmark_count(scheme);
  if (points.size() != 2 * count || sigmas.size() != count) {
    return refuse(fmt::format("{} coordinates and {} sigmas of landmarks, and {} has {} and {}",
                              points.size(), sigmas.size(), to_string(scheme), 2 * count, count));
  }
  FaceLandmarks face{.scheme = scheme, .points = {}, .box = {box[0], box[1], box[2], box[3]}};
  for (std::size_t i = 0; i < count; ++i) {
    face.points.push_back({.point = {points[2 * i], points[2 * i + 1]}, .sigma = sigmas[i]});
  }
  return face;
}

}  // namespace detail

/// The pixels of a message, seen in place, or why they are not a mono8 image.
inline Expected<ImageView> image_of(const msg::Image& image) {
  if (image.encoding_() != "mono8") {
    return refuse(fmt::format("the image is '{}', not mono8", image.encoding_()));
  }
  if (image.width_() == 0 || image.height_() == 0 || image.step_() < image.width_() ||
      image.data_().size() < std::size_t{image.step_()} * image.height_()) {
    return refuse(fmt::format("an image of {} x {} pixels with {} bytes in steps of {}",
                              image.width_(), image.height_(), image.data_().size(),
                              image.step_()));
  }
  return ImageView{.data = image.data_().data(),
                   .width = static_cast<int>(image.width_()),
                   .height = static_cast<int>(image.height_()),
                   .stride = image.step_()};
}

/// Writes everything but the header and the brightness of the whole image.
inline void write_landmarks(const StereoLandmarks& found, msg::FaceLandmarks& message) {
  message.valid_(true);
  message.reason_().clear();
  message.scheme_() = to_string(found.left.scheme);
  message.left_box_(detail::box_of(found.left.box));
  message.right_box_(detail::box_of(found.right.box));
  message.score_(found.left.score);
  message.face_intensity_(found.left.mean_intensity);
  detail::write_points(found.left, message.left_(), message.left_sigma_());
  detail::write_points(found.right, message.right_(), message.right_sigma_());
}

/// The same of a pair without a face.
inline void write_no_landmarks(const std::string& reason, msg::FaceLandmarks& message) {
  write_landmarks({}, message);
  message.scheme_().clear();
  message.valid_(false);
  message.reason_() = reason;
}

/// The landmarks of a valid message, or why they are none.
inline Expected<StereoLandmarks> landmarks_of(const msg::FaceLandmarks& message) {
  const auto scheme = find_landmark_scheme(message.scheme_());
  if (!scheme) return refuse(fmt::format("no landmark scheme is '{}'", message.scheme_()));
  auto left = detail::face_of(*scheme, message.left_(), message.left_sigma_(), message.left_box_());
  if (!left) return refuse("left: " + left.error().text);
  auto right =
      detail::face_of(*scheme, message.right_(), message.right_sigma_(), message.right_box_());
  if (!right) return refuse("right: " + right.error().text);
  left->score = message.score_();
  left->mean_intensity = message.face_intensity_();
  return StereoLandmarks{std::move(*left), std::move(*right)};
}

}  // namespace armature
