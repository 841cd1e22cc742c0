// SPDX-License-Identifier: Apache-2.0
#include "network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>
#include <utility>

#include "mirrored_points.hpp"

namespace armature::landmarks::face_mesh {
namespace {

constexpr std::ptrdiff_t kColours = 3;
constexpr std::size_t kCoordinates = 3 * kPoints;  // column, row and depth of each point

/// Keeps OpenCV from writing to the terminal what it throws as well.
class QuietOpenCv {
 public:
  QuietOpenCv() = default;
  ~QuietOpenCv() { cv::utils::logging::setLogLevel(before_); }
  QuietOpenCv(const QuietOpenCv&) = delete;
  QuietOpenCv& operator=(const QuietOpenCv&) = delete;

 private:
  cv::utils::logging::LogLevel before_ =
      cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
};

/// What OpenCV complains about, without the place in its own sources.
std::string complaint(const std::exception& error) {
  const auto* of_opencv = dynamic_cast<const cv::Exception*>(&error);
  std::string text = of_opencv ? of_opencv->err : error.what();
  std::ranges::replace(text, '\n', ' ');
  return text;
}

}  // namespace

struct Network::Parts {
  cv::dnn::Net net;
  std::vector<cv::String> names;  // of the answers
  cv::Mat picture;
  std::vector<cv::Mat> answers;
};

Network::Network(std::unique_ptr<Parts> parts) : parts_{std::move(parts)} {
  parts_->names = parts_->net.getUnconnectedOutLayersNames();
  parts_->picture.create({1, kColours, kPixels, kPixels}, CV_32F);
  parts_->picture.setTo(0.5);
}

Network::~Network() = default;

std::span<float> Network::picture() {
  return {parts_->picture.ptr<float>(), std::size_t{kPixels} * kPixels};
}

Mesh Network::look() {
  const std::span<float> grey = picture();
  for (std::ptrdiff_t colour = 1; colour < kColours; ++colour) {
    std::ranges::copy(grey, grey.data() + colour * std::ssize(grey));
  }
  // OpenCV divides work among threads of its own, except inside of what it has divided already.
  cv::parallel_for_({0, 1}, [this](const cv::Range&) {
    parts_->net.setInput(parts_->picture);
    parts_->net.forward(parts_->answers, parts_->names);
  });
  Mesh mesh;
  for (const cv::Mat& answer : parts_->answers) {
    const auto* values = answer.ptr<float>();
    if (answer.total() == 1) mesh.presence = 1 / (1 + std::exp(-double{values[0]}));
    if (answer.total() != kCoordinates) continue;
    for (std::size_t i = 0; i < kPoints; ++i) {
      mesh.points.emplace_back(values[3 * i], values[3 * i + 1]);
    }
  }
  return mesh;
}

/// Why this is not the network of the face mesh, or nothing.
std::string Network::misfit() {
  if (parts_->names.size() != 2) return fmt::format("it has {} outputs", parts_->names.size());
  const Mesh mesh = look();
  if (mesh.points.size() != kPoints) return "none of its outputs are the points";
  const auto is_number = [](const Eigen::Vector2d& point) { return point.allFinite(); };
  return std::ranges::all_of(mesh.points, is_number) ? "" : "its points are not finite";
}

Expected<std::unique_ptr<Network>> Network::read(const std::string& file) {
  const std::string hint = "; expected is the file that tools/fetch-face-mesh makes";
  if (!std::ifstream{file}) return refuse("cannot open the face mesh " + file + hint);
  try {
    const QuietOpenCv quiet;
    auto parts = std::make_unique<Parts>();
    parts->net = cv::dnn::readNetFromONNX(file);
    std::unique_ptr<Network> network{new Network{std::move(parts)}};
    const std::string misfit = network->misfit();
    if (misfit.empty()) return network;
    return refuse(
        fmt::format("{} is another network than the face mesh: {}, and {} points and the "
                    "presence of a face were expected{}",
                    file, misfit, kPoints, hint));
  } catch (const std::exception& error) {
    return refuse(
        fmt::format("{} is no face mesh that OpenCV can run ({}){}", file, complaint(error), hint));
  }
}

}  // namespace armature::landmarks::face_mesh
