// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "armature/robot/orientations/chart_piece.hpp"
#include "armature/robot/orientations/orientation_state.hpp"
#include "armature/robot/orientations/squad.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// How an orientation goes through its keys.
enum class OrientationInterpolator {
  slerp,           // great arcs; the angular velocity jumps at keys
  squad,           // Shoemake 1987; the angular acceleration jumps at keys
  rotvec_bspline,  // Zhong et al. 2023: rotation vectors, lines with blended corners; C2, depends
                   // on the base frame
  chart_bspline,   // the same blends told at their key: great arcs with blended corners; C2
};
/// By the name of its enumerator.
std::optional<OrientationInterpolator> orientation_interpolator(std::string_view name);

/// A rotation as a function of u, through key rotations: data, evaluated anywhere.
class OrientationCurve {
 public:
  /// Through unit quaternions (q and -q are one) at ascending parameters `u`. Without `u` these run
  /// from 0 to 1 in proportion to the turns between the keys (rotvec_bspline: to the distances of
  /// rotation vectors), which is one common speed; but rotvec_bspline through three keys is the
  /// paper's: line, blend and line last a third each. Refuses: fewer than two keys, a key that is
  /// not finite or no unit (within 1 %), parameters that do not fit or ascend, without parameters
  /// two equal neighbours, neighbours half a turn apart (antipodal), for rotvec_bspline a key that
  /// is half a turn itself.
  static Expected<OrientationCurve> through(std::span<const Eigen::Quaterniond> keys,
                                            OrientationInterpolator interpolator,
                                            std::span<const double> u = {});

  /// Real-time safe: no allocation, O(log pieces). The end rotations are held beyond the ends, with
  /// the rates that the curve has there; where pieces meet, those of the later one.
  OrientationState at(double u, Rates rates = Rates::acceleration) const;

  /// The parameter of each key.
  const std::vector<double>& key_parameters() const { return u_; }
  /// Where pieces begin, ascending: between these the curve is smooth.
  const std::vector<double>& piece_starts() const { return starts_; }

 private:
  using Pieces = std::variant<std::vector<ChartPiece>, std::vector<SquadPiece>>;
  OrientationCurve(std::vector<double> u, std::vector<double> starts, Pieces pieces);
  template <Rates rates>
  OrientationState sample(double u) const;

  std::vector<double> u_, starts_;
  Pieces pieces_;
};

}  // namespace armature
