// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "armature/kinds/ik/ik.hpp"

// Many goals in one call: reachability maps, sampling planners, tables. Structures of arrays, so
// that a solver can answer as many goals at once as its processor has lanes.
namespace armature ARMATURE_EXPORT {

/// Poses of the tool frame in the base frame, number by number: goal i is at position[0][i],
/// position[1][i], position[2][i]. With a `rotation`, or for robots with a pointing axis a
/// `direction`: the other one's pointers are null. The arrays are the caller's.
struct IkBatch {
  std::size_t count = 0;
  std::array<const double*, 3> position{};   // x, y, z [m]
  std::array<const double*, 4> rotation{};   // w, x, y, z of a quaternion, which need not be unit
  std::array<const double*, 3> direction{};  // x, y, z of a vector, which need not be unit
  IkGoal::Tolerance tolerance;

  /// The `i`th one by itself; with neither rotation nor direction a zero quaternion, which no
  /// solver takes.
  IkGoal goal(std::size_t i) const;
};

/// The answers, number by number. Branches stand in slots, which rise in the order in which `solve`
/// answers them: each has its own where `label` names it, otherwise they stand close together.
class IkBatchAnswers {
 public:
  static constexpr int kMaxSlots = 16;
  static_assert(IkBranches::kCapacity <= kMaxSlots);

  /// Of the branch that a slot is for, static storage; empty: for any.
  std::array<std::string_view, kMaxSlots> label;
  std::vector<IkStatus::Code> code;
  /// Bit b: of the branch in slot b.
  std::vector<std::uint16_t> found, within_limits, singular;
  /// By which forward kinematics miss the goal: the largest of its branches.
  std::vector<double> position_m, angle_rad;

  /// Makes room for as many; allocates only where there never was as much. No slot has a label.
  void resize(std::size_t goals, int dof, int slots);
  std::size_t goals() const { return found.size(); }
  int slots() const { return slots_; }
  /// Values of a joint of the branches in a slot, goal by goal; of those that were not found
  /// anything.
  double* joint(int slot, int joint) { return joints_.data() + offset(slot, joint); }
  const double* joint(int slot, int joint) const { return joints_.data() + offset(slot, joint); }

  /// Puts what `solve` answered for the `i`th goal into the slots that `slot_of` says.
  template <class SlotOf>
  void set(std::size_t i, const IkStatus& status, const IkBranches& branches, SlotOf slot_of) {
    begin(i, status);
    for (const IkBranch& branch : branches) set(i, slot_of(branch), branch);
  }

 private:
  std::size_t offset(int slot, int joint) const {
    return static_cast<std::size_t>(slot * dof_ + joint) * goals();
  }
  void begin(std::size_t i, const IkStatus& status);
  void set(std::size_t i, int slot, const IkBranch& branch);

  int dof_ = 0, slots_ = 0;
  std::vector<double> joints_;
};

}  // namespace armature
