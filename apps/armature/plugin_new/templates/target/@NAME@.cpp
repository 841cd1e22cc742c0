#include <array>

#include "@TARGET@_parameters.hpp"  // made from plugin.yaml
#include "armature/kinds/target/target.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace @NAMESPACE@ {
namespace {

/// All that is remembered, as plain bytes that belong to the caller.
struct Memory {
  static constexpr auto kLayout = layout_id("@ID@", 1);  // count up when the struct changes
  Time stamp;
  int measurements;
  std::array<double, 3> position, normal;
};

bool is_sound(const TargetMeasurement& m) {
  constexpr double kMaxVariance = 1e6;  // [m2], [rad2]: more says nothing
  const auto sound = [](const Eigen::Matrix3d& covariance) {
    return covariance.allFinite() && covariance.diagonal().minCoeff() >= 0 &&
           covariance.trace() < kMaxVariance;
  };
  return m.position.allFinite() && m.normal.allFinite() && m.normal.norm() > 0.5 &&
         sound(m.position_covariance) && sound(m.normal_covariance);
}

TargetEstimate estimate_at(Time when, const Memory& memory) {
  return {.stamp = when,
          .position = Eigen::Vector3d{memory.position.data()},
          .normal = Eigen::Vector3d{memory.normal.data()},
          .measurements = memory.measurements};
}

}  // namespace

class @CLASS@ final : public TargetFilter {
 public:
  explicit @CLASS@(const Params& params) : parameters_{Parameters::read(params)} {}

  Expected<TargetEstimate> update(const TargetMeasurement& m, PluginState& state) const override {
    const Memory* before = state.get<Memory>();
    if (!is_sound(m))
      return refuse("the measurement is not finite, or claims an impossible variance");
    if (before && m.stamp < before->stamp) return refuse("it is older than the one before");
    const Eigen::Vector3d normal = m.normal.normalized();
    const Memory now{m.stamp,
                     before ? before->measurements + 1 : 1,
                     {m.position.x(), m.position.y(), m.position.z()},
                     {normal.x(), normal.y(), normal.z()}};
    state.set(now);
    return estimate_at(m.stamp, now);
  }
  Expected<TargetEstimate> predict(Time when, const PluginState& state) const override {
    const Memory* memory = state.get<Memory>();
    if (!memory) return refuse("nothing has been measured yet");
    if (when - memory->stamp > seconds(parameters_.max_gap))
      return refuse("nothing was measured for too long");
    return estimate_at(when, *memory);
  }

 private:
  Parameters parameters_;
};
}  // namespace @NAMESPACE@
ARMATURE_PLUGIN(@NAMESPACE@::@CLASS@);
