// SPDX-License-Identifier: Apache-2.0
#include "reproduce/papers.hpp"

namespace armature::reproduce {

const std::vector<Paper>& papers() {
  static const std::vector<Paper> all{{"master", "master_manipulator.yaml", compute_master}};
  return all;
}

}  // namespace armature::reproduce
