// SPDX-License-Identifier: Apache-2.0
#include "bench/loop/loop_work.hpp"

#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "armature/messages/stamp.hpp"
#include "armature/runtime/component/setup.hpp"
#include "bench/allocations.hpp"
#include "bench/processors.hpp"

namespace armature::bench {

const std::string_view LoopComponent::kPlugin = R"(
armature_plugin: 1
id: bench/loop
kind: component
doc: A control loop that does next to nothing, for `armature bench loop`.
out:
  joint_state: {type: sensor_msgs/JointState, topic: joint_state, doc: "Once a step."}
)";

void tiny_work(std::uint64_t step, msg::JointState& state) {
  state.position_().resize(kJoints);
  state.velocity_().resize(kJoints);
  for (std::size_t i = 0; i < kJoints; ++i) {
    const double phase = 1e-3 * static_cast<double>(step % 1'000'000) + static_cast<double>(i);
    state.position_()[i] = std::sin(phase);
    state.velocity_()[i] = std::cos(phase);
  }
}

ThreadCounts counts_of_this_thread() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  const AllocationCounter allocations = allocation_counter();
  return {.page_faults = static_cast<std::uint64_t>(usage.ru_minflt + usage.ru_majflt),
          .allocations = allocations ? allocations() : 0};
}

bool Requests::ask(ThreadCounts& counts) {
  requested_.store(true);
  for (int i = 0; i < 1000 && requested_.load(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
  }
  counts = {.page_faults = page_faults_.load(), .allocations = allocations_.load()};
  return !requested_.load();
}

void Requests::answer() {
  if (const int cpu = cpu_.exchange(kNone); cpu != kNone) move_to_cpu(cpu);
  if (!requested_.load()) return;
  const ThreadCounts counts = counts_of_this_thread();
  page_faults_.store(counts.page_faults);
  allocations_.store(counts.allocations);
  requested_.store(false);
}

LoopComponent::LoopComponent(Setup& setup)
    : Component{setup}, state_{setup.output<msg::JointState>("joint_state")} {}

void LoopComponent::step(Time now) {
  requests_.answer();
  auto loan = state_.loan();
  set_stamp(loan->header_().stamp_(), now);
  tiny_work(steps_++, *loan);
  loan.publish();
}

}  // namespace armature::bench
