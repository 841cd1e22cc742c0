// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>

#include "armature/values/time.hpp"

namespace armature::report::lamp_alignment {

/// SHA-256 over joint samples: int64 nanoseconds, then the joints as doubles, all little-endian.
/// Two runs that moved alike to the last bit have the same one.
class TrajectoryHash {
 public:
  TrajectoryHash();
  ~TrajectoryHash();
  TrajectoryHash(const TrajectoryHash&) = delete;
  TrajectoryHash& operator=(const TrajectoryHash&) = delete;

  void add(Time stamp, std::span<const double> joints);
  /// Of everything added so far: 64 hexadecimal digits.
  std::string hex() const;

 private:
  struct Digest;
  std::unique_ptr<Digest> digest_;
};

}  // namespace armature::report::lamp_alignment
