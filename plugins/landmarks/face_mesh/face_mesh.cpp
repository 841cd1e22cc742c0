// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
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

constexpr double kBoxScale = 1.8;   // the network looks at the detector's box, this much larger,
constexpr double kMeshScale = 1.4;  // then at what it found there, this much larger

/// The square about a mesh, larger by kMeshScale.
Crop crop_around(const Mesh& mesh) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& point : mesh.points) box.extend(point);
  return {.middle = box.center(), .side = kMeshScale * box.sizes().maxCoeff()};
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

/// The mesh of the picture of a crop as one of the image.
Mesh in_image(Mesh mesh, const Crop& crop) {
  for (Eigen::Vector2d& point : mesh.points) point = crop.in_image(point, Network::kPixels);
  return mesh;
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
  Expected<Mesh> present(const Mesh& mesh) const;
  Expected<Mesh> search(const ImageView& image, const Crop& crop);
  Expected<std::vector<Landmark>> look(const ImageView& image, const Crop& crop);

  Parameters parameters_;
  std::unique_ptr<Network> network_;
};

Expected<std::unique_ptr<LandmarkFinder>> FaceMesh::make(const Params& params) {
  const Parameters parameters = Parameters::read(params);
  auto network = Network::read(parameters.model);
  if (!network) return tl::unexpected{network.error()};
  return std::make_unique<FaceMesh>(parameters, std::move(*network));
}

Expected<Mesh> FaceMesh::present(const Mesh& mesh) const {
  if (mesh.presence >= parameters_.min_presence) return mesh;
  return refuse(fmt::format("the presence of a face is {:.2f}, less than {:.2f}", mesh.presence,
                            parameters_.min_presence));
}

/// Where the face is, roughly.
Expected<Mesh> FaceMesh::search(const ImageView& image, const Crop& crop) {
  cut(image, crop, Network::kPixels, network_->picture());
  return present(in_image(network_->look(), crop));
}

// The network is no better on one side of a face than on the other: the mean of what it sees in a
// picture and in the mirrored one errs less than either, and their distance tells by how much.
Expected<std::vector<Landmark>> FaceMesh::look(const ImageView& image, const Crop& crop) {
  cut(image, crop, Network::kPixels, network_->picture());
  const auto seen = present(in_image(network_->look(), crop));
  if (!seen) return tl::unexpected{seen.error()};
  mirror(network_->picture());
  const auto other = present(in_image(mirrored(network_->look()), crop));
  if (!other) return tl::unexpected{other.error()};

  const double apart = distance(*seen, *other), eyes = eye_distance(*seen);
  if (!(apart <= parameters_.max_asymmetry * eyes)) {
    return refuse(
        fmt::format("the mirrored picture shows the face elsewhere, by {:.0f} % of the distance of "
                    "the eyes, more than {:.0f} %",
                    100 * apart / eyes, 100 * parameters_.max_asymmetry));
  }
  // Half of a squared distance belongs to each direction, and a quarter of that is the variance of
  // a mean of two.
  const double sigma = std::max(apart / std::sqrt(8.0), parameters_.min_sigma);
  std::vector<Landmark> landmarks;
  for (std::size_t i = 0; i < kPoints; ++i) {
    landmarks.push_back({.point = 0.5 * (seen->points[i] + other->points[i]), .sigma = sigma});
  }
  return landmarks;
}

Expected<std::vector<Landmark>> FaceMesh::find(const ImageView& image, const PixelBox& face) {
  if (auto wrong = invalid_input(image)) return refuse(*wrong);
  if (auto wrong = invalid_input(face)) return refuse(*wrong);
  const auto rough =
      search(image, {.middle = {face.left + 0.5 * face.width, face.top + 0.5 * face.height},
                     .side = kBoxScale * std::max(face.width, face.height)});
  if (!rough) return tl::unexpected{rough.error()};
  return look(image, crop_around(*rough));
}

}  // namespace armature::landmarks::face_mesh

ARMATURE_PLUGIN(armature::landmarks::face_mesh::FaceMesh);
