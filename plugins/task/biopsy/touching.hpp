// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "task_biopsy_parameters.hpp"
#include "tip_rest.hpp"

namespace armature::task::biopsy {

/// The places that a tip in a hand touches, in any order, until there are as many as the plan has
/// markers. That a place can be one of them is seen by its distances from those before: two markers
/// of the plan must be as far apart. Which one it is, and whether all of them fit, is the
/// registration's to say.
class Touching {
 public:
  explicit Touching(const Parameters& parameters);

  /// The markers of the plan [m], in its image; nothing has been touched.
  void begin(std::vector<Eigen::Vector3d> planned);
  /// Where the tip is [m], in the base frame.
  void see_tip(const Eigen::Vector3d& tip, Time stamp) { rest_.see(tip, stamp); }
  /// A hand begins to lead the arm: what was seen of the tip before is no touch.
  void begin_rest();

  /// The place where the tip rests is the next one; or why it is none.
  Expected<void> take(Time now);
  /// The tip rests, and has moved since the last `take` or `begin`.
  bool rests_anew(Time now);
  /// Where it rests [m], or why it does not.
  Expected<Eigen::Vector3d> place(Time now) const { return rest_.place(now); }
  void drop_last();
  /// The tip rests outside of the ball about all places, with `min_touch_clearance` to spare, so
  /// that the arm may move by itself; or why not.
  Expected<void> is_clear(Time now) const;

  /// [m], in the base frame.
  const std::vector<Eigen::Vector3d>& places() const { return places_; }
  std::size_t count() const { return planned_.size(); }
  /// Is another one after every change of `places`.
  std::size_t version() const { return version_; }

 private:
  /// Why it cannot be a marker besides those before, or "".
  std::string contradiction(const Eigen::Vector3d& place) const;

  Parameters parameters_;
  TipRest rest_;
  std::vector<Eigen::Vector3d> planned_, places_;
  bool moved_ = false;
  std::size_t version_ = 0;
};

}  // namespace armature::task::biopsy
