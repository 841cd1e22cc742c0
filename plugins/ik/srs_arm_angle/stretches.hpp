// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "arm_kernel.hpp"
#include "feasible_angles.hpp"

namespace armature {

/// A span of a branch, in arm angles of elbow 0: its places in the table, but for ones at its ends,
/// are first, ..., end - 1. A span across the cut at pi is two stretches that both know its ends,
/// with a place at the cut. Of a tiny one or a point there are the ends alone.
struct Stretch {
  Span span;
  std::size_t branch;
  int first, end;
  bool cut_below, cut_above;
};

/// Those of all branches. Spans with less than two places get three more, behind the sorted ones,
/// but for those in which single precision would not tell places apart.
class Stretches {
 public:
  static constexpr std::size_t kMax = 8 * Spans::kCapacity;
  static constexpr int kFew = 2, kInner = 3;
  static constexpr double kTiny = 1e-3;  // [rad]

  /// The sorted places of `table` must be set before the first span comes.
  explicit Stretches(CostTable& table) : table_{table} {}

  void add(std::size_t branch, const Spans& spans);

  const Stretch* begin() const { return stretch_.data(); }
  const Stretch* end() const { return stretch_.data() + count_; }

 private:
  void add_across_cut(std::size_t branch, const Span& before, const Span& behind);
  void add_stretch(std::size_t branch, const Span& span);
  void add_narrow(std::size_t branch, const Span& span);
  void put(const Stretch& stretch) { stretch_[count_++] = stretch; }

  CostTable& table_;
  std::array<Stretch, kMax> stretch_;
  std::size_t count_ = 0;
};

}  // namespace armature
