// SPDX-License-Identifier: Apache-2.0
#include <exception>

#include "armature/kinds/ik/ik.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace armature {
namespace {

class OwnException final : public std::exception {
 public:
  const char* what() const noexcept override { return "an exception of its own type"; }
};

}  // namespace

class Throwing final : public IkSolver {
 public:
  Throwing(const RobotModel&, const Params&) { throw OwnException{}; }
  IkStatus solve(const IkGoal&, const JointVector&, IkBranches&, IkState&) const override {
    return {};
  }
};

}  // namespace armature

ARMATURE_PLUGIN(armature::Throwing);
