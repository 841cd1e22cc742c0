#include <Eigen/Geometry>

#include "@TARGET@_parameters.hpp"  // made from plugin.yaml
#include "armature/kinds/face_pose/face_pose.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace @NAMESPACE@ {
namespace {

// Left eye, right eye, mouth: u, v of each in the left picture, then in the right one [px]; and
// what follows from them: x, y, z of each [m], and the normal.
constexpr std::array kFeatures{FaceFeature::left_eye, FaceFeature::right_eye, FaceFeature::mouth};
using Vector12 = Eigen::Matrix<double, 12, 1>;

Vector12 points_and_normal(const Vector12& pixels, const StereoCamera& camera) {
  Vector12 face;
  for (int i = 0; i < 3; ++i) {
    face.segment<3>(3 * i) =
        camera.triangulate(pixels.segment<2>(2 * i), pixels.segment<2>(6 + 2 * i));
  }
  const Eigen::Vector3d mouth = face.segment<3>(6);
  face.tail<3>() = (face.segment<3>(3) - mouth).cross(face.head<3>() - mouth).normalized();
  return face;
}

}  // namespace

class @CLASS@ final : public FacePoseEstimator {
 public:
  explicit @CLASS@(const Params& params) : parameters_{Parameters::read(params)} {}

  Expected<FacePose> estimate(const FacePoseInput& input, PluginState&) override {
    Vector12 pixels, variances;
    for (int k = 0; k < 6; ++k) {
      const FaceLandmarks& seen = k < 3 ? input.landmarks.left : input.landmarks.right;
      if (seen.points.size() != landmark_count(seen.scheme))
        return refuse("not all landmarks were found");
      const Landmark feature = seen.feature(kFeatures[static_cast<std::size_t>(k % 3)]);
      pixels.segment<2>(2 * k) = feature.point;
      variances.segment<2>(2 * k).setConstant(feature.sigma * feature.sigma);
    }
    if (!pixels.allFinite() || !variances.allFinite() || !(variances.array() > 0).all())
      return refuse("a landmark is not finite, or its sigma is not positive");
    for (int i = 0; i < 6; i += 2) {
      if (!(pixels[i] > pixels[6 + i]))
        return refuse("the right picture is not to the left one's right");
    }
    const Vector12 face = points_and_normal(pixels, input.camera);
    const double eyes = (face.segment<3>(3) - face.head<3>()).norm();
    if (!(eyes > parameters_.min_eye_distance && eyes < parameters_.max_eye_distance))
      return refuse("the eyes would be " + std::to_string(1e3 * eyes) + " mm apart");
    if (!(face.tail<3>().dot(face.segment<3>(6)) < 0))
      return refuse("the face would be seen from behind");

    // How the errors of the pixels go on: C = J diag(variances) J^T, with central differences.
    constexpr double kStep = 1e-3;  // [px]
    Eigen::Matrix<double, 12, 12> J;
    for (int k = 0; k < 12; ++k) {
      const Vector12 step = kStep * Vector12::Unit(k);
      J.col(k) = (points_and_normal(pixels + step, input.camera) -
                  points_and_normal(pixels - step, input.camera)) /
                 (2 * kStep);
    }
    const Eigen::Vector3d n = face.tail<3>();
    J.bottomRows<3>() -= n * (n.transpose() * J.bottomRows<3>());  // a direction errs across itself
    const Eigen::Matrix<double, 12, 12> C = J * variances.asDiagonal() * J.transpose();
    return FacePose{face.head<3>(),          face.segment<3>(3),
                    face.segment<3>(6),      n,
                    C.topLeftCorner<3, 3>(), C.block<3, 3>(3, 3),
                    C.block<3, 3>(6, 6),     C.bottomRightCorner<3, 3>()};
  }

 private:
  Parameters parameters_;
};
}  // namespace @NAMESPACE@
ARMATURE_PLUGIN(@NAMESPACE@::@CLASS@);
