// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <string>

namespace armature {

/// `armature fk` and `armature ik`: JSON lines in, one JSON line out for each, in order. A bad line
/// is answered with a reason and the next one goes on; memory stays bounded. They use the robot
/// model and a solver plugin, nothing else: no DDS, no OpenCV.
int run_fk(const std::string& robot_file, std::istream& in, std::ostream& out);
int run_ik(const std::string& robot_file, const std::string& plugin_id, std::istream& in,
           std::ostream& out);

}  // namespace armature
