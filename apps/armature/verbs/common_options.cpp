// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>

#include "verbs/option_checks.hpp"
#include "verbs/verbs.hpp"

namespace armature {

void add_source(CLI::App& verb, DeploymentSource& source) {
  verb.add_option("files", source.files,
                  "deployment: a file, or a name that came with armature (dental_lamp); then "
                  "overlays that change it")
      ->required();
  verb.add_option("--set", source.assignments,
                  "change one value: --set components.motion.ik.plugin=ik/numeric")
      ->allow_extra_args(false);
}

void add_network(CLI::App& verb, NetworkOptions& network) {
  verb.add_option("--interface", network.interfaces,
                  "join this one beside loopback, by name or IPv4 address")
      ->allow_extra_args(false)
      ->check(no_interface);
  verb.add_option("--peer", network.peers,
                  "find the processes of this host without multicast, by name or IPv4 address")
      ->allow_extra_args(false)
      ->check(no_host);
  verb.add_option("--discovery-server", network.discovery_server,
                  "find others through this one: host or host:port")
      ->check(no_server)
      ->excludes("--peer");
  verb.add_flag("--no-shared-memory{false}", network.shared_memory,
                "over UDP only, as between containers");
}

void add_monitor_address(CLI::App& verb, MonitorAddress& server) {
  verb.add_option("--bind", server.address,
                  "IPv4 address of this machine to listen at; beyond loopback a token is asked for")
      ->capture_default_str()
      ->check(CLI::ValidIPV4);
  add_ranged(&verb, "--port", server.port, "0: any that is free", 0, 65535);
  verb.add_option("--origin", server.origins,
                  "let pages from there connect, too: http://localhost:8080")
      ->allow_extra_args(false);
  verb.add_option("--token", server.token, "what clients must say: ws://HOST:PORT/?token=...")
      ->check(no_token);
}

void add_watch(CLI::App& verb, WatchOptions& options) {
  verb.add_option("--domain", options.network.domain, "DDS domain")->check(CLI::Range(0, 232));
  add_network(verb, options.network);
  verb.add_option("--timeout", options.timeout_s, "give up after this many seconds")
      ->check(not_positive);
  verb.add_flag("--json", options.json, "as JSON");
}

void add_seed(CLI::App* verb, std::uint64_t& seed, const std::string& what) {
  verb->add_option("--seed", seed, what)->capture_default_str()->check(wrong_seed);
}

void add_arm(CLI::App* verb, ArmChoice& arm) {
  verb->add_option("--robot", arm.robot, "robot file, or URDF file (*.urdf) with --tip");
  verb->add_option("--tip", arm.tip,
                   "frame that goals are stated for, instead of 'tool'; of a URDF file a link");
  verb->add_option("--base", arm.base, "link of a URDF file that is the base (its root)");
}

}  // namespace armature
