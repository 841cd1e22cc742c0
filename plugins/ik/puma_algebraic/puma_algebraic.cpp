// SPDX-License-Identifier: Apache-2.0
#include "puma_algebraic.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "armature/kinds/ik/batch.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace armature {
namespace {

constexpr std::size_t kSlots = 8, kNoDepth = 4;

/// "shoulder1/elbow0/wrist1/depth2", without the depth where a branch has none of its own. Shoulder
/// 0: the wrist lies ahead of link 1. Elbow 0: t3 + atan2(d4, a3) >= 0. Wrist 0: t5 >= 0. Depths
/// are counted from shallow to deep.
std::string_view label_of(std::size_t branch, std::size_t depth = kNoDepth) {
  constexpr std::string_view kFirst = "shoulder0/elbow0/wrist0/depth0", kDepth = "/depth0";
  static constexpr auto kNames = [&] {
    std::array<std::array<char, kFirst.size()>, 4 * kSlots> names{};
    for (std::size_t i = 0; i < names.size(); ++i) {
      std::ranges::copy(kFirst, names[i].begin());
      for (const auto& [place, part] : {std::pair{8, 16}, {15, 8}, {22, 4}}) {
        names[i][static_cast<std::size_t>(place)] = "01"[i / static_cast<std::size_t>(part) % 2];
      }
      names[i].back() = "0123"[i % 4];
    }
    return names;
  }();
  if (depth == kNoDepth) return {kNames[4 * branch].data(), kFirst.size() - kDepth.size()};
  return {kNames[4 * branch + depth].data(), kFirst.size()};
}

IkStatus status_of(const IkBranches& branches) {
  const bool any =
      std::any_of(branches.begin(), branches.end(), [](auto& b) { return b.within_limits; });
  if (any) return {};
  return {IkStatus::Code::joint_limit, 0, "every branch leaves the joint limits"};
}

IkStatus out_of_reach(const Miss& miss) {
  return {IkStatus::Code::out_of_reach, miss.by, miss.why};
}

IkBranch& add_branch(const FourArms& arms, std::size_t arm, std::size_t wrist,
                     std::string_view label, double redundancy, IkBranches& out) {
  IkBranch& branch = out.add();
  branch.label = label;
  branch.q.resize(6);
  for (std::size_t i = 0; i < 6; ++i) {
    branch.q.data()[i] = arms.joint[wrist][i][arm];
  }
  branch.redundancy = redundancy;
  branch.residual = {arms.position_m[arm], arms.angle_rad[arm]};
  branch.within_limits = arms.margin[wrist][arm] >= 0;
  branch.singular = arms.singular[arm];
  return branch;
}

}  // namespace

ArmKernels arm_kernels() {
  ArmKernels list{{portable::arm_kernel()}, 1};
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return list;
  list.kernel[list.count++] = avx2::arm_kernel();
  const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                    __builtin_cpu_supports("avx512vl");
  if (wide) list.kernel[list.count++] = avx512::arm_kernel();
#endif
  return list;
}

PumaAlgebraic::PumaAlgebraic(const RobotModel& model, const PumaArm& arm)
    : model_{&model}, arm_{arm} {
  const ArmKernels kernels = arm_kernels();
  kernel_ = kernels.kernel[kernels.count - 1];
}

Expected<std::unique_ptr<IkSolver>> PumaAlgebraic::make(const RobotModel& model, const Params&) {
  auto arm = puma_arm(model);
  if (!arm) return tl::unexpected{arm.error()};
  return std::unique_ptr<IkSolver>{new PumaAlgebraic{model, *arm}};
}

std::optional<double> PumaAlgebraic::redundancy_of(const JointVector& q) const {
  if (!arm_.pointing) return std::nullopt;
  return arm_.needle ? q[5] : wrap_angle(q[5]);
}

IkStatus PumaAlgebraic::add_branches(const ArmQuestion& question, FourArms& arms,
                                     IkBranches& out) const {
  kernel_.solve(arm_, question, arms);
  const bool pointing = question.task == ArmQuestion::Task::pointing;
  for (std::size_t i = 0; i < 8; ++i) {
    if (!arms.reached[i / 2]) continue;
    IkBranch& branch =
        add_branch(arms, i / 2, i % 2, label_of(i), pointing ? question.sixth : 0, out);
    // What the arm cannot do at this depth it may do with the needle's help.
    if (branch.singular && arm_.needle) {
      branch.singular = manipulability(*model_, branch.q) < 1e-6;
    }
  }
  return out.count > 0 ? status_of(out) : out_of_reach(min_miss(arm_, question.wrist));
}

IkStatus PumaAlgebraic::solve_at(const ArmQuestion& question, IkBranches& out) const {
  constexpr int kSteps = 64;
  FourArms arms;
  const IkStatus status = add_branches(question, arms, out);
  if (status.code != IkStatus::Code::joint_limit) return status;
  const bool free2 = std::ranges::any_of(arms.free2, std::identity{});
  if (!arms.free1 && !free2) return status;
  for (int step = 1; step <= kSteps; ++step) {
    for (const double side : {1.0, -1.0}) {
      ArmQuestion other = question;
      double& angle = arms.free1 ? other.kept.t1 : other.kept.t2;
      angle = wrap_angle(angle + side * step * std::numbers::pi / kSteps);
      FourArms there;
      out.clear();
      if (add_branches(other, there, out).code == IkStatus::Code::ok) return {};
    }
  }
  out.clear();
  return add_branches(question, arms, out);
}

IkStatus PumaAlgebraic::solve_line(const PumaGoal& goal, IkBranches& out) const {
  const double wanted = goal.at_zero.sixth;
  const IkStatus status = solve_at(goal.at(wanted), out);
  if (status.code == IkStatus::Code::ok) return status;
  const NeedleLine line{kernel_, arm_, goal, model_->lower()[5], model_->upper()[5]};
  const NearestDepth nearest = nearest_to_reach(line);
  if (nearest.miss.by > goal.at_zero.rims.slack) return out_of_reach(nearest.miss);
  IkBranches chosen;
  const IkStatus other = solve_at(goal.at(choose_depth(line, wanted, nearest.depth)), chosen);
  if (other.code != IkStatus::Code::ok && out.count > 0) return status;
  out = chosen;
  return other;
}

IkStatus PumaAlgebraic::solve_needle_rotation(const PumaGoal& goal, IkBranches& out) const {
  // A root at the very end of the range may be rounded beyond it.
  constexpr double kEnd = 1e-10;
  const NeedleLine line{kernel_, arm_, goal, model_->lower()[5] - kEnd, model_->upper()[5] + kEnd};
  const NearestDepth nearest = nearest_to_reach(line);
  if (nearest.miss.by > goal.at_zero.rims.slack) return out_of_reach(nearest.miss);
  const RollRoots roots = roll_roots(line, nearest.depth);
  for (std::size_t arm = 0; arm < 4; ++arm) {
    std::array<std::size_t, 2> found{};  // of each wrist
    for (std::size_t i = 0; i < roots.of[arm].count; ++i) {
      const RollRoots::Root& root = roots.of[arm].root[i];
      ArmQuestion question = goal.at(root.depth);
      question.task = ArmQuestion::Task::fixed_roll;
      question.wrist_factor = std::abs(root.slope) * (arm_.a2 + arm_.forearm);
      FourArms arms;
      kernel_.solve(arm_, question, arms);
      if (!arms.reached[arm]) continue;
      // Which wrist it is, the sign of t5 tells.
      const double t5 = wrap_angle(arm_.canonical(4, arms.joint[0][4][arm]));
      const std::size_t wrist = t5 < 0 ? 1 : 0;
      add_branch(arms, arm, 0, label_of(2 * arm + wrist, found[wrist]++), root.depth, out);
    }
  }
  if (out.count > 0) return status_of(out);
  return {IkStatus::Code::no_convergence, roots.min_error,
          "no depth within the needle's range was found at which the roll comes right"};
}

IkStatus PumaAlgebraic::solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                              IkState&) const {
  out.clear();
  if (const char* why = invalid_input(*model_, goal, seed)) {
    return {IkStatus::Code::invalid_input, 0, why};
  }
  const bool pointing = std::holds_alternative<Direction>(goal.pose.orientation);
  if (pointing && !arm_.pointing) {
    return {IkStatus::Code::invalid_input, 0,
            "a direction needs a tool that lies on the axis of joint 6 and points along it; give a "
            "rotation"};
  }
  if (!pointing && goal.redundancy) {
    return {IkStatus::Code::invalid_input, 0, "a full rotation leaves nothing redundant"};
  }
  PumaGoal own = puma_goal(arm_, goal, seed);
  if (arm_.needle && goal.redundancy) return solve_at(own.at(*goal.redundancy), out);
  if (arm_.needle) return pointing ? solve_line(own, out) : solve_needle_rotation(own, out);
  if (goal.redundancy) own.at_zero.sixth = wrap_angle(*goal.redundancy);
  return solve_at(own.at_zero, out);
}

void solve_together(const ArmKernel& kernel, const PumaArm& arm, const IkBatch& batch,
                    IkBatchAnswers& out) {
  PoseBatch poses{batch.count, {}, {}, rims_of(arm, batch.tolerance)};
  std::ranges::copy(batch.position, poses.position);
  std::ranges::copy(batch.rotation, poses.rotation);
  PoseAnswers answers{{},
                      out.found.data(),
                      out.within_limits.data(),
                      out.singular.data(),
                      out.position_m.data(),
                      out.angle_rad.data()};
  for (int slot = 0; slot < 8; ++slot) {
    for (int i = 0; i < 6; ++i) answers.joint[slot][i] = out.joint(slot, i);
  }
  kernel.solve_poses(arm, poses, answers);
}

void PumaAlgebraic::solve_batch(const IkBatch& batch, const JointVector& seed,
                                IkBatchAnswers& out) const {
  const bool together = !arm_.needle && batch.rotation[0] != nullptr &&
                        batch.direction[0] == nullptr && batch.tolerance.position_m > 0 &&
                        batch.tolerance.angle_rad > 0 && seed.size() == 6 && seed.allFinite();
  if (!together) return IkSolver::solve_batch(batch, seed, out);
  out.resize(batch.count, 6, kSlots);
  for (std::size_t slot = 0; slot < kSlots; ++slot) out.label[slot] = label_of(slot);
  solve_together(kernel_, arm_, batch, out);
  IkBranches branches;
  for (std::size_t i = 0; i < batch.count; ++i) {
    if (out.found[i] == PoseAnswers::kSpecial) {
      IkState state;
      const IkStatus status = solve(batch.goal(i), seed, branches, state);
      out.set(i, status, branches, [&](const IkBranch& branch) {
        return static_cast<int>(std::ranges::find(out.label, branch.label) - out.label.begin());
      });
    } else {
      out.code[i] = out.found[i] == 0           ? IkStatus::Code::out_of_reach
                    : out.within_limits[i] == 0 ? IkStatus::Code::joint_limit
                                                : IkStatus::Code::ok;
    }
  }
}

}  // namespace armature

ARMATURE_PLUGIN(armature::PumaAlgebraic);
