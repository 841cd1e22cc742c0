// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "armature/kinds/landmarks/landmarks.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "crop.hpp"
#include "landmarks_face_mesh_parameters.hpp"
#include "mirrored_points.hpp"
#include "network.hpp"

namespace armature::landmarks::face_mesh {
namespace {

constexpr double kCropScale = 1.4;  // the network looks at the detector's box, this much larger
constexpr double kMinFace = 1;      // [px] width of a box that can hold a face at all
constexpr double kMaxFace = 1e5;

/// Why a box can hold no face, or nothing. Written so that what is not finite is refused, too.
std::optional<std::string> invalid_box(const PixelBox& face) {
  const auto is_size = [](double size) { return size >= kMinFace && size <= kMaxFace; };
  if (!is_size(face.width) || !is_size(face.height)) return "the face's box has no size";
  const double shape = face.height / face.width;
  if (shape < 0.1 || shape > 10) return "the face's box is ten times as long as wide";
  const auto is_near = [](double at) { return std::abs(at) <= kMaxFace; };
  if (!is_near(face.left) || !is_near(face.top)) return "the face's box is not in the image";
  return std::nullopt;
}

/// What the network looks at for the box `i` of `boxes`: those after the first lie about it, evenly
/// on a disc, and are larger or smaller.
Crop crop_of(const PixelBox& face, int i, int boxes) {
  constexpr double kShift = 0.05, kSize = 0.05;       // of the box
  constexpr double kGoldenAngle = 2.399963229728653;  // [rad]
  const double side = std::max(face.width, face.height);
  const double away = kShift * side * std::sqrt(static_cast<double>(i) / boxes);
  const double size = 1 + kSize * std::sin(i);
  return {.middle = {face.left + 0.5 * face.width + away * std::cos(i * kGoldenAngle),
                     face.top + 0.5 * face.height + away * std::sin(i * kGoldenAngle)},
          .side = kCropScale * size * side};
}

void mirror(std::span<float> picture) {
  for (auto row = picture.begin(); row != picture.end(); row += Network::kPixels) {
    std::reverse(row, row + Network::kPixels);
  }
}

/// The mesh of a mirrored picture as one of the picture itself.
Mesh mirrored(const Mesh& mesh) {
  Mesh result{.points = mesh.points, .presence = mesh.presence};
  for (std::size_t i = 0; i < kPoints; ++i) {
    const Eigen::Vector2d& point = mesh.points[kMirroredPoints[i]];
    result.points[i] = {Network::kPixels - 1 - point.x(), point.y()};
  }
  return result;
}

/// The distance of the eyes' centres [px].
double eye_distance(const Mesh& mesh) {
  const auto centre = [&](FaceFeature eye) {
    const auto around = landmarks_around(eye, LandmarkScheme::mesh468);
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const std::size_t i : around) sum += mesh.points[i];
    return Eigen::Vector2d{sum / static_cast<double>(around.size())};
  };
  return (centre(FaceFeature::right_eye) - centre(FaceFeature::left_eye)).norm();
}

/// The distance [px] of the points of two meshes, rms.
double distance(const Mesh& a, const Mesh& b) {
  double sum = 0;
  for (std::size_t i = 0; i < kPoints; ++i) sum += (a.points[i] - b.points[i]).squaredNorm();
  return std::sqrt(sum / kPoints);
}

}  // namespace

/// The points of MediaPipe's face mesh (see README).
class FaceMesh final : public LandmarkFinder {
 public:
  FaceMesh(const Parameters& parameters, std::unique_ptr<Network> network)
      : parameters_{parameters}, network_{std::move(network)} {}
  static Expected<std::unique_ptr<LandmarkFinder>> make(const Params& params);

  LandmarkScheme scheme() const override { return LandmarkScheme::mesh468; }
  Expected<std::vector<Landmark>> find(const ImageView& image, const PixelBox& face) override;

 private:
  Expected<Mesh> look(const ImageView& image, const Crop& crop, double& variance);

  Parameters parameters_;
  std::unique_ptr<Network> network_;
};

Expected<std::unique_ptr<LandmarkFinder>> FaceMesh::make(const Params& params) {
  const Parameters parameters = Parameters::read(params);
  auto network = Network::read(parameters.model);
  if (!network) return tl::unexpected{network.error()};
  return std::make_unique<FaceMesh>(parameters, std::move(*network));
}

// The network is no better on one side of a face than on the other: the mean of what it sees in a
// picture and in the mirrored one errs less than either, and their distance tells by how much.
Expected<Mesh> FaceMesh::look(const ImageView& image, const Crop& crop, double& variance) {
  cut(image, crop, Network::kPixels, network_->picture());
  const Mesh seen = network_->look();
  mirror(network_->picture());
  const Mesh other = mirrored(network_->look());

  Mesh mean{.points = {}, .presence = std::min(seen.presence, other.presence)};
  if (!(mean.presence >= parameters_.min_presence)) {
    return refuse(fmt::format("the presence of a face is {:.2f}, less than {:.2f}", mean.presence,
                              parameters_.min_presence));
  }
  for (std::size_t i = 0; i < kPoints; ++i) {
    const Eigen::Vector2d point = 0.5 * (seen.points[i] + other.points[i]);
    mean.points.push_back(crop.in_image(point, Network::kPixels));
  }
  const double apart = distance(seen, other) * crop.side / Network::kPixels;
  const double eyes = eye_distance(mean);
  if (!(apart <= parameters_.max_asymmetry * eyes)) {
    return refuse(
        fmt::format("the mirrored picture shows the face elsewhere, by {:.0f} % of the distance of "
                    "the eyes, more than {:.0f} %",
                    100 * apart / eyes, 100 * parameters_.max_asymmetry));
  }
  // Half of a squared distance belongs to each direction, and a quarter of that is the variance of
  // a mean of two.
  variance = apart * apart / 8;
  return mean;
}

Expected<std::vector<Landmark>> FaceMesh::find(const ImageView& image, const PixelBox& face) {
  if (auto wrong = invalid_input(image)) return refuse(*wrong);
  if (auto wrong = invalid_box(face)) return refuse(*wrong);
  const int boxes = parameters_.boxes;
  std::vector<Landmark> landmarks(kPoints);
  double variance = 0;
  for (int i = 0; i < boxes; ++i) {
    double of_look = 0;
    const auto mesh = look(image, crop_of(face, i, boxes), of_look);
    if (!mesh) return tl::unexpected{mesh.error()};
    for (std::size_t k = 0; k < kPoints; ++k) landmarks[k].point += mesh->points[k] / boxes;
    variance += of_look / (boxes * boxes);
  }
  for (Landmark& landmark : landmarks) {
    landmark.sigma = std::max(std::sqrt(variance), parameters_.min_sigma);
  }
  return landmarks;
}

}  // namespace armature::landmarks::face_mesh

ARMATURE_PLUGIN(armature::landmarks::face_mesh::FaceMesh);
