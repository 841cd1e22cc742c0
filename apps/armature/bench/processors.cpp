// SPDX-License-Identifier: Apache-2.0
#include "bench/processors.hpp"

#include <pthread.h>
#include <sched.h>

#include <stdexcept>
#include <vector>

namespace armature::bench {

std::pair<int, int> two_cpus() {
  cpu_set_t set;
  CPU_ZERO(&set);
  sched_getaffinity(0, sizeof set, &set);
  std::vector<int> cpus;
  for (int cpu = 0; cpu < CPU_SETSIZE && cpus.size() < 2; ++cpu) {
    if (CPU_ISSET(static_cast<std::size_t>(cpu), &set)) cpus.push_back(cpu);
  }
  if (cpus.size() < 2) {
    throw std::runtime_error{
        "two processors are needed, one for each side of the comparison; this process may use one"};
  }
  return {cpus[0], cpus[1]};
}

void move_to_cpu(int cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(cpu), &set);
  pthread_setaffinity_np(pthread_self(), sizeof set, &set);
}

}  // namespace armature::bench
