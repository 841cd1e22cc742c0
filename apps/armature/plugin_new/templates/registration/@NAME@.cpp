#include "@TARGET@_parameters.hpp"  // made from plugin.yaml
#include "armature/kinds/registration/registration.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace @NAMESPACE@ {
/// Every marker counts; one that disagrees is not found out.
class @CLASS@ final : public Registrar {
 public:
  explicit @CLASS@(const Params& params) : parameters_{Parameters::read(params)} {}

  Expected<Registration> find(const MarkerPairs& markers) const override {
    if (auto wrong = invalid_input(markers, 3)) return refuse(*wrong);
    Registration found;
    found.used.assign(markers.image.size(), true);
    found.condition = condition_of_line(markers.image);
    if (!(found.condition <= parameters_.max_condition)) {
      return refuse("the markers lie nearly on one line: condition " +
                    std::to_string(found.condition));
    }
    Eigen::Matrix3Xd image(3, markers.image.size()), robot = image;
    for (Eigen::Index i = 0; i < image.cols(); ++i) {
      image.col(i) = markers.image[static_cast<std::size_t>(i)];
      robot.col(i) = markers.robot[static_cast<std::size_t>(i)];
    }
    found.robot_T_image.matrix() = Eigen::umeyama(image, robot, false);
    measure_residuals(markers, found);
    return found;
  }

 private:
  Parameters parameters_;
};
}  // namespace @NAMESPACE@
ARMATURE_PLUGIN(@NAMESPACE@::@CLASS@);
