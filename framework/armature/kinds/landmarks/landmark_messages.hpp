// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>

#include "armature/kinds/landmarks/image_view.hpp"
#include "armature/kinds/landmarks/landmarks.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/values/expected.hpp"

namespace armature {

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

inline void assign(std::vector<double>& to, const FaceLandmarks& face) {
  to.resize(2 * FaceLandmarks::kCount);
  for (std::size_t i = 0; i < FaceLandmarks::kCount; ++i) {
    to[2 * i] = face.points[i].x();
    to[2 * i + 1] = face.points[i].y();
  }
}

/// The landmarks of a valid message, or why they are none.
inline Expected<StereoLandmarks> landmarks_of(const msg::FaceLandmarks& message) {
  constexpr std::size_t kNumbers = 2 * FaceLandmarks::kCount;
  if (message.left_().size() != kNumbers || message.right_().size() != kNumbers) {
    return refuse(fmt::format("{} and {} landmark coordinates, not {}", message.left_().size(),
                              message.right_().size(), kNumbers));
  }
  StereoLandmarks result;
  for (std::size_t i = 0; i < FaceLandmarks::kCount; ++i) {
    result.left.points[i] = {message.left_()[2 * i], message.left_()[2 * i + 1]};
    result.right.points[i] = {message.right_()[2 * i], message.right_()[2 * i + 1]};
  }
  const auto box = [](const auto& b) { return PixelBox{b[0], b[1], b[2], b[3]}; };
  result.left.box = box(message.left_box_());
  result.right.box = box(message.right_box_());
  result.left.score = message.score_();
  result.left.mean_intensity = message.face_intensity_();
  return result;
}

}  // namespace armature
