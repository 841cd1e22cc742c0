// SPDX-License-Identifier: Apache-2.0
#include "reproduce/papers.hpp"

namespace armature::reproduce {

const std::vector<Paper>& papers() {
  static const std::vector<Paper> all{{"lamp", "dental_lamp.yaml", compute_lamp},
                                      {"sr1", "sr1.yaml", compute_sr1},
                                      {"implant", "dental_implant.yaml", compute_implant},
                                      {"master", "master_manipulator.yaml", compute_master}};
  return all;
}

}  // namespace armature::reproduce
