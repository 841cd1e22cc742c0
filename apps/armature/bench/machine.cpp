// SPDX-License-Identifier: Apache-2.0
#include "bench/machine.hpp"

#include <fmt/format.h>
#include <sched.h>
#include <sys/utsname.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

namespace armature::bench {
namespace {

std::string processor_name() {
  std::ifstream file{"/proc/cpuinfo"};
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

int usable_processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 0;
}

}  // namespace

Machine this_machine() {
  Machine machine{processor_name(), usable_processors(), "unknown", "", 0};
  if (utsname names{}; uname(&names) == 0) {
    machine.system = fmt::format("{} {}", names.sysname, names.release);
  }
#ifdef __clang__
  machine.compiler = fmt::format("Clang {}, {}", __clang_version__, ARMATURE_COMPILE_FLAGS);
#else
  machine.compiler = fmt::format("GCC {}, {}", __VERSION__, ARMATURE_COMPILE_FLAGS);
#endif
  getloadavg(&machine.load, 1);
  return machine;
}

nlohmann::ordered_json to_json(const Machine& machine) {
  return {{"processor", machine.processor},
          {"processors", machine.processors},
          {"load", machine.load},
          {"system", machine.system},
          {"compiler", machine.compiler}};
}

std::string to_text(const Machine& machine) {
  return fmt::format("{}, {} processors, load {:.1f}; {}; {}", machine.processor,
                     machine.processors, machine.load, machine.system, machine.compiler);
}

}  // namespace armature::bench
