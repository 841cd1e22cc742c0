// SPDX-License-Identifier: Apache-2.0
#include "replay/watched_ik.hpp"

#include <chrono>
#include <utility>

#include "armature/kinds/ik/batch.hpp"
#include "armature/kinds/ik/lines/asking.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace armature {
namespace {

class WatchedIk final : public IkSolver {
 public:
  /// What the next one that a slot makes is to watch.
  struct Subject {
    std::shared_ptr<PluginLibrary> library;
    IkCalls* calls;
  };
  static thread_local std::optional<Subject> next;

  static Expected<std::unique_ptr<IkSolver>> make(const RobotModel& robot, const Params& params) {
    auto solver = reinterpret_cast<IkSolver::Factory>(next->library->factory())(robot, params);
    if (!solver) return tl::unexpected{solver.error()};
    return std::make_unique<WatchedIk>(*next, robot, std::move(*solver));
  }

  WatchedIk(Subject subject, const RobotModel& robot, std::unique_ptr<IkSolver> solver)
      : subject_{std::move(subject)}, robot_{robot}, solver_{std::move(solver)} {}

  IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                 IkState& state) const override {
    const IkState before = state;
    const auto start = std::chrono::steady_clock::now();
    const IkStatus status = solver_->solve(goal, seed, out, state);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    IkCalls& calls = *subject_.calls;
    ++calls.count;
    calls.took_s += took.count();
    const bool failed = !reaches(status);
    if (failed) ++calls.failed;
    const bool is_slowest = !calls.slowest || took.count() > calls.slowest->took_s;
    const bool is_first = failed && !calls.first_failed;
    if (!is_slowest && !is_first) return status;
    const IkQuestion question{.goal = goal,
                              .seed = seed,
                              .state = before,
                              .redundancy_is_length = solver_->redundancy_is_length(),
                              .id = {}};
    const IkCalls::Call call{.question = question_line(robot_, question),
                             .answer = describe(status),
                             .took_s = took.count()};
    if (is_slowest) calls.slowest = call;
    if (is_first) calls.first_failed = call;
    return status;
  }
  std::optional<double> redundancy_of(const JointVector& q) const override {
    return solver_->redundancy_of(q);
  }
  bool feasible_redundancy(const IkGoal& goal, const JointVector& seed,
                           RedundancyIntervals& out) const override {
    return solver_->feasible_redundancy(goal, seed, out);
  }
  bool redundancy_is_length() const override { return solver_->redundancy_is_length(); }
  void solve_batch(const IkBatch& batch, const JointVector& seed,
                   IkBatchAnswers& out) const override {
    solver_->solve_batch(batch, seed, out);
  }

 private:
  Subject subject_;  // its library goes after the solver
  RobotModel robot_;
  std::unique_ptr<IkSolver> solver_;
};

thread_local std::optional<WatchedIk::Subject> WatchedIk::next;

}  // namespace

Expected<void> watch_ik(SlotPlace& slot, SlotPlugin plugin, IkCalls& calls) {
  auto library = PluginLibrary::of_this_program(detail::plugin_entry<WatchedIk>(), IkSolver::kKind);
  if (!library) return tl::unexpected{library.error()};
  WatchedIk::next = WatchedIk::Subject{plugin.library, &calls};
  plugin.library = std::move(*library);
  auto offered = slot.offer(std::move(plugin));
  WatchedIk::next.reset();
  return offered;
}

}  // namespace armature
