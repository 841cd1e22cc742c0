// SPDX-License-Identifier: Apache-2.0
#include "two_hosts.hpp"

#include <csignal>
#include <filesystem>
#include <string_view>
#include <thread>
#include <utility>

namespace armature::test {
namespace {

constexpr std::chrono::seconds kMadeWithin{10};
const std::string kIp = "/bin/ip";
const std::vector<std::string> kHold{
    "/bin/sh", "-c",
    "mount -t tmpfs tmpfs /dev/shm && ip link set dev lo up && echo ready && exec sleep infinity"};

std::vector<std::string> appended(std::vector<std::string> words,
                                  const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

bool hold(TwoHosts::Host& host, const std::vector<std::string>& words) {
  host.holder = std::make_unique<Command>(
      words,
      Command::Options{.environment = {{"PATH", "/sbin:/bin:/usr/sbin:/usr/bin"}}, .input = {}});
  return host.holder->wait_for_out("ready", kMadeWithin);
}

/// The kernel takes its time after both ends are up.
bool wait_for_link(const TwoHosts::Host& host) {
  const auto show = host.command({kIp, "link", "show", "dev", TwoHosts::kInterface});
  for (const auto end = std::chrono::steady_clock::now() + kMadeWithin;
       run_command(show).out.find(" state UP ") == std::string::npos;) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
  }
  return true;
}

}  // namespace

pid_t TwoHosts::Host::pid() const {
  const pid_t forked = holder->child();
  return forked > 0 ? forked : holder->pid();
}

std::vector<std::string> TwoHosts::Host::command(std::vector<std::string> words) const {
  return appended({"/usr/bin/nsenter", "--target", std::to_string(pid()), "--user",
                   "--preserve-credentials", "--net", "--mount", "--time"},
                  words);
}

TwoHosts::TwoHosts(const std::vector<std::string>& faults) : missing_{make(faults)} {}

int TwoHosts::counted() {
  cable_->signal(SIGTERM);
  const std::string out = cable_->finish(kMadeWithin).out;
  const std::string_view word = "counted ";
  return std::stoi(out.substr(out.rfind(word) + word.size()));
}

std::string TwoHosts::make(const std::vector<std::string>& faults) {
  const std::vector<std::string> unshare{"/usr/bin/unshare", "--user", "--map-root-user", "--net",
                                         "--mount"};
  if (!std::filesystem::exists(kIp)) return "no " + kIp + " here (iproute2)";
  if (run_command(appended(unshare, {"/bin/true"})).exit_code != 0) {
    return "no network namespace may be made here";
  }
  if (!hold(robot_, appended(unshare, kHold))) return "no host: " + robot_.holder->err();
  const auto beside = robot_.command(appended({"/usr/bin/unshare", "--net", "--mount"}, kHold));
  const auto later = robot_.command(appended({"/usr/bin/unshare", "--net", "--mount", "--time",
                                              "--monotonic", "5000", "--fork", "--kill-child"},
                                             kHold));
  if (!hold(desk_, later)) return "no second host: " + desk_.holder->err();
  if (!faults.empty() && !hold(between_, beside)) return "no cable: " + between_.holder->err();
  if (const std::string failed = connect(faults); !failed.empty()) return failed;
  for (const Host* host : {&robot_, &desk_}) {
    for (const auto& words : std::vector<std::vector<std::string>>{
             {kIp, "address", "add", host->address + "/24", "dev", kInterface},
             {kIp, "link", "set", "dev", kInterface, "up"}}) {
      const auto set = run_command(host->command(words));
      if (set.exit_code != 0) return "no address: " + set.err;
    }
  }
  return wait_for_link(robot_) && wait_for_link(desk_) ? "" : "no link between them";
}

std::string TwoHosts::connect(const std::vector<std::string>& faults) {
  const auto plug = [](const Host& host, const std::string& far_end, const Host& there) {
    return run_command(host.command({kIp, "link", "add", "dev", kInterface, "type", "veth", "peer",
                                     "name", far_end, "netns", std::to_string(there.pid())}));
  };
  if (faults.empty()) {
    const auto cable = plug(robot_, kInterface, desk_);
    return cable.exit_code == 0 ? "" : "no cable between them: " + cable.err;
  }
  for (const auto& [host, end] : {std::pair{&robot_, "robot"}, std::pair{&desk_, "desk"}}) {
    const auto cable = plug(*host, end, between_);
    const auto up = run_command(between_.command({kIp, "link", "set", "dev", end, "up"}));
    if (cable.exit_code != 0 || up.exit_code != 0) return "no cable: " + cable.err + up.err;
  }
  cable_ =
      std::make_unique<Command>(between_.command(appended({CABLE_RELAY, "robot", "desk"}, faults)));
  return cable_->wait_for_out("ready", kMadeWithin) ? "" : "no relay: " + cable_->err();
}

}  // namespace armature::test
