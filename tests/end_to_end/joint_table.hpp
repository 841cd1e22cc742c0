// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace armature::test {

/// The table of `report/joints`. Empty fields are NaN.
struct JointTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;

  std::size_t column(const std::string& name) const;
  /// Of the positions of all joints.
  std::vector<std::size_t> positions() const;
};

/// Expects whole lines of as many fields as there are names.
JointTable read_joint_table(const std::string& text);

}  // namespace armature::test
