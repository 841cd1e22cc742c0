// SPDX-License-Identifier: Apache-2.0
#include "two_hosts.hpp"

#include <filesystem>
#include <thread>

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

std::vector<std::string> TwoHosts::Host::command(std::vector<std::string> words) const {
  return appended({"/usr/bin/nsenter", "--target", std::to_string(holder->pid()), "--user",
                   "--preserve-credentials", "--net", "--mount"},
                  words);
}

TwoHosts::TwoHosts() : missing_{make()} {}

std::string TwoHosts::make() {
  const std::vector<std::string> unshare{"/usr/bin/unshare", "--user", "--map-root-user", "--net",
                                         "--mount"};
  if (!std::filesystem::exists(kIp)) return "no " + kIp + " here (iproute2)";
  if (run_command(appended(unshare, {"/bin/true"})).exit_code != 0) {
    return "no network namespace may be made here";
  }
  if (!hold(robot_, appended(unshare, kHold))) return "no host: " + robot_.holder->err();
  const auto beside = robot_.command(appended({"/usr/bin/unshare", "--net", "--mount"}, kHold));
  if (!hold(desk_, beside)) return "no second host: " + desk_.holder->err();
  const auto cable = run_command(
      robot_.command({kIp, "link", "add", "dev", kInterface, "type", "veth", "peer", "name",
                      kInterface, "netns", std::to_string(desk_.holder->pid())}));
  if (cable.exit_code != 0) return "no cable between them: " + cable.err;
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

}  // namespace armature::test
