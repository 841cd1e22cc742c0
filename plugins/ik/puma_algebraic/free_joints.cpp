// SPDX-License-Identifier: Apache-2.0
#include "free_joints.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "armature/robot/model/joint_vector.hpp"

namespace armature {
namespace {

/// From the middle of the range of joint `i`, the short way round.
double offset(const ArmNumbers& arm, int i, double q) {
  const double straight = q - arm.middle[i];
  return arm.needle && i == 5 ? straight : wrap_angle(straight);
}

/// As in ArmKernel::solve.
double margin(const ArmNumbers& arm, const double (&joint)[6][4], int of) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 6; ++i) {
    least = std::min(least, arm.half[i] - std::abs(offset(arm, i, joint[i][of])));
  }
  return least + 1e-9;
}

/// How far joint 4 has to go, joint 6 going `ratio` times as far, for both to keep their limits; 0
/// when no way does it. One of them ends at a limit.
double way_to_limits(const ArmNumbers& arm, double q4, double q6, double ratio) {
  double best = std::numeric_limits<double>::infinity();
  for (const double end : {-1.0, 1.0}) {
    for (const double way : {wrap_angle(arm.middle[3] + end * arm.half[3] - q4),
                             ratio * wrap_angle(arm.middle[5] + end * arm.half[5] - q6)}) {
      const bool inside4 = std::abs(offset(arm, 3, q4 + way)) <= arm.half[3] + 1e-12;
      const bool inside6 = std::abs(offset(arm, 5, q6 + ratio * way)) <= arm.half[5] + 1e-12;
      if (inside4 && inside6 && std::abs(way) < std::abs(best)) best = way;
    }
  }
  return std::isfinite(best) ? best : 0;
}

}  // namespace

double nearest_within_limits(const ArmNumbers& arm, int i, double q) {
  const double inside = std::clamp(offset(arm, i, q), -arm.half[i], arm.half[i]);
  const double nearest = arm.middle[i] + inside;
  return arm.needle && i == 5 ? nearest : wrap_angle(nearest);
}

void share_rolls(const ArmNumbers& arm, FourArms& answer) {
  for (int i = 0; i < 4; ++i) {
    if (!answer.reached[i] || !answer.kept4[i] || answer.margin[0][i] >= 0) continue;
    double &q4 = answer.joint[0][3][i], &q6 = answer.joint[0][5][i];
    const double t5 = arm.sign[4] * (answer.joint[0][4][i] + arm.zero[4]);
    const double same = std::cos(t5) > 0 ? -1 : 1;  // t6 goes against t4, or with it
    const double ratio = same * arm.sign[3] * arm.sign[5];
    const double way = way_to_limits(arm, q4, q6, ratio);
    q4 = wrap_angle(q4 + way);
    q6 = wrap_angle(q6 + ratio * way);
    answer.joint[1][3][i] = q4;
    answer.joint[1][5][i] = q6;
    answer.margin[0][i] = answer.margin[1][i] = margin(arm, answer.joint[0], i);
  }
}

}  // namespace armature
