// SPDX-License-Identifier: Apache-2.0
#include "doctor/judge.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "armature/bus/fast_dds/receive_buffer.hpp"
#include "armature/bus/fast_dds/shared_memory.hpp"
#include "shell_word.hpp"

namespace armature::doctor {
namespace {

using Findings = std::vector<Finding>;

// Limits of a login come from this file; a session that was open before keeps its own.
constexpr const char* kRaiseLimit =
    "echo \"$(id -un) - {0}\" | sudo tee -a /etc/security/limits.d/armature.conf  # then log in "
    "again; in a container: docker run --ulimit {1}";

std::string limit_text(const Limit& limit, std::uint64_t unit, std::string_view name) {
  return limit ? fmt::format("{}{}", *limit / unit, name) : "unlimited";
}

void judge_shared_memory(const SharedMemoryFacts& memory, Findings& findings) {
  if (!memory.unusable.empty()) {
    findings.push_back(
        {Level::warning, "shared memory", memory.unusable,
         "topics between processes go over UDP, which takes longer for images",
         fmt::format("sudo mkdir -p {0} && sudo mount -t tmpfs -o mode=1777 tmpfs {0}",
                     memory.folder)});
    return;
  }
  findings.push_back({Level::ok, "shared memory", memory.folder + " is writable",
                      "processes of this machine exchange topics through it", ""});
  const std::string value = fmt::format("{} MiB", memory.free_bytes >> 20);
  const std::string needs = fmt::format("a process takes {} MiB", kSharedMemoryOfProcess >> 20);
  if (memory.free_bytes < kSharedMemoryOfProcess) {
    findings.push_back(
        {Level::warning, "free shared memory", value,
         needs + "; without them its topics go over UDP",
         fmt::format("sudo mount -o remount,size=512M {}  # in a container: docker run "
                     "--shm-size=512m",
                     memory.folder)});
  } else {
    findings.push_back({Level::ok, "free shared memory", value, needs, ""});
  }
  if (memory.left_over.empty()) {
    findings.push_back({Level::ok, "left-over segments", "0",
                        "no dead process of this user left files there", ""});
  } else {
    findings.push_back(
        {Level::warning, "left-over segments",
         fmt::format("{} ({}{})", memory.left_over.size(), memory.left_over.front().string(),
                     memory.left_over.size() > 1 ? ", ..." : ""),
         "dead processes left them; the next run removes them", "armature run dental_lamp"});
  }
}

void judge_rights(const RightsFacts& rights, Findings& findings) {
  const std::string rtprio = limit_text(rights.rtprio, 1, "");
  if (rights.priority_refused.empty()) {
    findings.push_back({Level::ok, "real-time priority",
                        fmt::format("SCHED_FIFO 80 allowed (rtprio {})", rtprio),
                        "executors get the priority that their file names", ""});
  } else {
    findings.push_back(
        {Level::warning, "real-time priority",
         fmt::format("SCHED_FIFO 80 refused: {} (rtprio {})", rights.priority_refused, rtprio),
         "executors with a priority run as normal threads, and late under load",
         fmt::format(kRaiseLimit, "rtprio 95", "rtprio=95")});
  }
  const std::string memlock = limit_text(rights.memlock_bytes, 1024, " KiB");
  if (rights.memory_refused.empty()) {
    findings.push_back({Level::ok, "locked memory",
                        fmt::format("mlockall allowed (memlock {})", memlock),
                        "lock_memory keeps a process in RAM", ""});
  } else {
    findings.push_back({Level::warning, "locked memory",
                        fmt::format("refused (memlock {}): {}", memlock, rights.memory_refused),
                        "with lock_memory a step may still wait for a page",
                        fmt::format(kRaiseLimit, "memlock unlimited", "memlock=-1")});
  }
  constexpr std::uint64_t kFiles = 1024;  // Debian's default
  const bool few = rights.nofile && *rights.nofile < kFiles;
  findings.push_back({few ? Level::warning : Level::ok, "open files",
                      fmt::format("at most {} (nofile)", limit_text(rights.nofile, 1, "")),
                      few ? "a deployment with many topics may run out of them"
                          : "enough for sockets, libraries and segments",
                      few ? fmt::format(kRaiseLimit, "nofile 4096", "nofile=4096") : ""});
}

void judge_kernel(const KernelFacts& kernel, Findings& findings) {
  findings.push_back(
      {kernel.real_time ? Level::ok : Level::warning, "kernel",
       fmt::format("{}, {}", kernel.release, kernel.real_time ? "PREEMPT_RT" : "not PREEMPT_RT"),
       kernel.real_time ? "a step is late by little, whatever else runs"
                        : "under load a step of a real-time executor may be late",
       kernel.real_time ? ""
                        : "sudo apt install linux-image-rt-$(dpkg --print-architecture)  # then "
                          "reboot; armature bench loop measures"});
  const bool one = kernel.processors < 2;
  findings.push_back(
      {one ? Level::warning : Level::ok, "processors", std::to_string(kernel.processors),
       one ? "a control thread shares it with everything else"
           : "a control thread can have one of its own (cpu:)",
       one ? "taskset -cp $$  # which ones; give the machine or container more" : ""});
  const auto& governors = kernel.governors;
  const bool slows =
      std::ranges::any_of(governors, [](const auto& g) { return g != "performance"; });
  findings.push_back(
      {slows ? Level::warning : Level::ok, "cpu frequency",
       governors.empty() ? "not told by the system"
                         : fmt::format("governor {}", fmt::join(governors, ", ")),
       slows               ? "a processor that had nothing to do begins its next step slowly"
       : governors.empty() ? "a virtual machine leaves it to its host"
                           : "no processor slows down while it has nothing to do",
       slows ? "echo performance | sudo tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor"
             : ""});
}

bool is_loopback(const NetworkInterface& interface) {
  return std::ranges::any_of(interface.addresses,
                             [](const std::string& text) { return text.starts_with("127."); });
}

void judge_receive_buffer(std::optional<std::uint64_t> bytes, Findings& findings) {
  if (!bytes) return;  // no Linux of ours
  const bool small = *bytes < kReceiveBuffer;
  findings.push_back(
      {small ? Level::warning : Level::ok, "receive buffer",
       fmt::format("at most {} bytes (net.core.rmem_max)", *bytes),
       small
           ? "of a picture over UDP a part is lost: what a deployment's own processes miss is sent "
             "again and late, what others miss is gone (armature topic hz tells)"
           : "a pair of pictures over UDP waits there until it is read",
       small ? fmt::format("echo net.core.rmem_max={} | sudo tee /etc/sysctl.d/60-armature.conf && "
                           "sudo sysctl --system",
                           kReceiveBuffer)
             : ""});
}

void judge_network(const NetworkFacts& network, Findings& findings) {
  const auto loopback = std::ranges::find_if(network.interfaces, is_loopback);
  if (loopback == network.interfaces.end() || !loopback->up) {
    findings.push_back({Level::problem, "loopback",
                        loopback == network.interfaces.end()
                            ? "no interface has an address 127.*"
                            : fmt::format("{} is down", loopback->name),
                        "processes do not find each other, nor does armature topic find them",
                        "sudo ip link set dev lo up"});
  } else {
    findings.push_back({Level::ok, "loopback", to_text({*loopback}),
                        "processes of this machine meet over it", ""});
  }
  const bool lost = !network.multicast_lost.empty();
  findings.push_back(
      {lost ? Level::problem : Level::ok, "multicast on loopback",
       lost ? network.multicast_lost : "239.255.0.1 answers",
       lost ? "DDS finds nobody; a firewall takes it, or the sandbox" : "DDS finds others by it",
       lost ? "sudo nft list ruleset  # what drops 239.255.0.1" : ""});
  judge_receive_buffer(network.max_receive_buffer, findings);
  std::vector<NetworkInterface> others;
  std::ranges::copy_if(network.interfaces, std::back_inserter(others), [](const auto& one) {
    return one.up && one.has_link && !one.addresses.empty() && !is_loopback(one);
  });
  findings.push_back({Level::ok, "other interfaces", others.empty() ? "none" : to_text(others),
                      others.empty() ? "a deployment stays on this machine"
                                     : "joined only when named (dds: {interfaces: [...]})",
                      ""});
}

void judge_clock(const ClockFacts& clock, Findings& findings) {
  constexpr std::int64_t kCoarse_ns = 1000;  // a hundredth of the shortest period
  const bool coarse = clock.resolution_ns > kCoarse_ns;
  findings.push_back({coarse ? Level::warning : Level::ok, "monotonic clock",
                      fmt::format("resolution {} ns", clock.resolution_ns),
                      coarse ? "periods below a few of these are not kept"
                             : "periods are kept to it, as far as the kernel is",
                      coarse ? "cat /proc/cmdline  # boot without highres=off and nohz=off" : ""});
  findings.push_back(
      {clock.synchronised ? Level::ok : Level::warning, "system clock",
       clock.synchronised ? fmt::format("synchronised, off by at most {:.3f} s", clock.max_error_s)
                          : "not synchronised",
       clock.synchronised ? "stamps can be compared with other machines'"
                          : "stamps of other machines may look old, or of the future",
       clock.synchronised ? ""
                          : "sudo apt install systemd-timesyncd; sudo timedatectl set-ntp true"});
}

void judge_plugins(const PluginFacts& plugins, Findings& findings) {
  for (const auto& folder : plugins.folders) {
    findings.push_back({Level::ok, "plugin folder", folder.string(), "searched in this order", ""});
  }
  for (const std::string& warning : plugins.warnings) {
    findings.push_back({Level::warning, "plugin search", warning,
                        "what stands there may not be what runs", "echo $ARMATURE_PLUGIN_PATH"});
  }
  const bool none = plugins.usable == 0;
  findings.push_back(
      {none ? Level::problem : Level::ok, "plugins", fmt::format("{} load", plugins.usable),
       none ? "no deployment can be made" : "each was loaded by a process of its own",
       none ? "export ARMATURE_PLUGIN_PATH=PREFIX/lib/armature/plugins" : ""});
  for (const auto& [file, reason] : plugins.unusable) {
    findings.push_back(
        {Level::problem, "plugin library", fmt::format("{}: {}", file.string(), reason),
         "a deployment that names it does not start",
         fmt::format("ldd -r {}  # then build it again, or remove it", shell_word(file.string()))});
  }
}

}  // namespace

std::string_view to_string(Level level) {
  switch (level) {
    case Level::ok: return "ok";
    case Level::warning: return "warning";
    case Level::problem: break;
  }
  return "problem";
}

std::vector<Finding> judge(const Facts& facts) {
  Findings findings;
  judge_shared_memory(facts.shared_memory, findings);
  judge_rights(facts.rights, findings);
  judge_kernel(facts.kernel, findings);
  judge_network(facts.network, findings);
  judge_clock(facts.clock, findings);
  judge_plugins(facts.plugins, findings);
  for (const auto& [of, number] : facts.versions) {
    findings.push_back({Level::ok, "version", fmt::format("{} {}", of, number),
                        "what this program was built with", ""});
  }
  return findings;
}

}  // namespace armature::doctor
