// SPDX-License-Identifier: Apache-2.0
// An arm that nobody has built, drawn by a number.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <initializer_list>
#include <kdl/chain.hpp>
#include <string>
#include <vector>

#include "armature/values/chance.hpp"
#include "armature/values/temporary_folder.hpp"

namespace armature::test {

using Numbers = std::vector<double>;
using Words = std::initializer_list<const char*>;

/// A generator of what differs between arms.
class Lot : public Chance {
 public:
  explicit Lot(int seed) : Chance(static_cast<std::uint64_t>(seed)) {}

  template <class T>
  T one_of(std::initializer_list<T> values) {
    return values.begin()[below(static_cast<int>(values.size()))];
  }
  Numbers three(double most);
};

/// A joint that moves by itself, [rad] or [m]. It reaches its speed in 0.25 s.
struct AnyJoint {
  double lower, upper, speed;
  bool ends;
};

/// Everything within a radius of a line on link l`link`, in its frame.
struct AnyBody {
  int link;
  KDL::Vector from, to;
  double radius;
};

/// An arm of so many joints.
struct AnyArm {
  AnyArm(Lot& lot, int joints);

  /// Of link l`link`, with the joints that move by themselves at `q`, which the others follow.
  KDL::Frame frame(int link, const double* q) const;
  KDL::Frame tool(const double* q) const;
  /// Gives every link a body, by which its robot file differs.
  void draw_bodies(Lot& lot);
  /// The URDF file and the robot file arm.yaml.
  void write(const TemporaryFolder& folder) const;

  std::string urdf, tip;
  std::vector<AnyJoint> joints;
  Numbers home, ratios;  // of all, to the first one; 0: it moves by itself
  KDL::Chain chain;
  std::vector<AnyBody> bodies;

 private:
  void add_joint(Lot& lot, int i);
};

}  // namespace armature::test
