// SPDX-License-Identifier: Apache-2.0
#include "operator/operator.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <functional>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "armature/task/procedure.hpp"
#include "armature/values/json_text.hpp"
#include "armature/values/time.hpp"
#include "armature/values/without_blanks.hpp"
#include "exit_code.hpp"
#include "operator/procedure_view.hpp"
#include "operator/shown_question.hpp"
#include "operator/task_link.hpp"
#include "run/named_deployment.hpp"
#include "standard_output.hpp"
#include "terminal_text.hpp"

namespace armature {
namespace {

using Steady = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kAskAgain{20}, kSayAgain{100};

std::atomic<bool> g_left{false};

/// Goes on while the machine sleeps.
Duration since_boot() {
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  return std::chrono::seconds{now.tv_sec} + Duration{now.tv_nsec};
}

const PortBinding* port_of(const std::vector<PortBinding>& ports, std::string_view type) {
  const auto found =
      std::ranges::find_if(ports, [&](const auto& port) { return port.spec.type == type; });
  return found == ports.end() ? nullptr : &*found;
}

/// The task that is meant, of those that an operator is heard by.
TaskTopics find_task(const DeploymentConfig& deployment, const std::string& component) {
  std::vector<TaskTopics> tasks;
  std::vector<std::string> names;
  for (const ComponentConfig& one : deployment.components) {
    const PortBinding* command = port_of(one.inputs, "armature_msgs/OperatorCommand");
    const PortBinding* state = port_of(one.outputs, "armature_msgs/TaskState");
    if (!command || !state || (!component.empty() && one.name != component)) continue;
    tasks.push_back({deployment.name, one.name, command->topic, state->topic});
    names.push_back(one.name);
  }
  if (tasks.size() == 1) return tasks.front();
  if (tasks.empty()) {
    throw InvalidChoice(fmt::format(
        "deployment '{}' has no {} that hears an operator, which an input of type "
        "armature_msgs/OperatorCommand does",
        deployment.name, component.empty() ? "component" : "component '" + component + "'"));
  }
  throw InvalidChoice(fmt::format("deployment '{}' has several tasks: --component {}",
                                  deployment.name, fmt::join(names, ", or ")));
}

/// One operator at a running task.
class Dialogue {
 public:
  using Join = std::function<std::unique_ptr<TaskLink>()>;
  Dialogue(const OperatorOptions& options, const DeploymentConfig& deployment, Join join)
      : options_{options}, deployment_{deployment}, join_{std::move(join)}, link_{join_()} {}

  /// kOk once the task has told what it does, or when the operator at a terminal has left before.
  int meet() {
    if (wait([&] { return link_->state() || link_->tasks().size() > 1; })) return kOk;
    if (g_left) return options_.say.empty() && is_terminal_ ? kOk : left_before(options_.say);
    fmt::print(stderr,
               "armature: no task of '{}' tells what it does in domain {} within {:g} s; is it "
               "running? armature run FILE --keep-running\n",
               deployment_.name, options_.domain.value_or(deployment_.domain), options_.timeout_s);
    return kTimedOut;
  }

  int say(const std::string& word, const std::string& step) {
    // Whoever confirms must know that nobody else says that he is the task.
    if (word == "confirm") wait([&] { return link_->knows_all(); });
    if (is_ambiguous()) return kFailed;
    const std::uint64_t id = ids_();
    Steady::time_point told{};
    const bool answered = wait([&] {
      if (told != Steady::time_point{} && link_->answer()) return true;
      if (!link_->state() || Steady::now() - told < kSayAgain) return false;
      told = Steady::now();
      link_->say(id, word, step);
      return false;
    });
    if (!answered) {
      if (is_ambiguous()) return kFailed;
      if (g_left && told == Steady::time_point{}) return left_before(word);
      if (g_left) {
        fmt::print(stderr, "armature: interrupted before the task answered '{}'\n", word);
        return kFailed;
      }
      fmt::print(stderr, "armature: the task did not answer '{}' within {:g} s\n", word,
                 options_.timeout_s);
      return kTimedOut;
    }
    const std::string refused = link_->answer().value_or("");
    if (refused.empty()) return kOk;
    fmt::print(stderr, "armature: '{}' was refused: {}\n", word, terminal_text(refused));
    return kFailed;
  }

  /// The step that a single "confirm" means: `step`, or the only one that the task asks about. Who
  /// does not see what waits would confirm whatever has come up: of several he must name one.
  Expected<std::string> step_meant(const std::string& step) const {
    const auto state = link_->state();
    if (!step.empty() || !state) return step;
    const std::vector<std::string> asking = steps_with_question(*state);
    const std::string waits = step_that_asks(*state);
    if (asking.size() == 1 || waits.empty()) return waits;
    return refuse(
        fmt::format("which of the {} steps that ask is meant? '{}' waits now: --step '{}'",
                    asking.size(), terminal_text(waits), terminal_text(waits)));
  }

  void show_if_changed() {
    look();
    const auto state = link_->state();
    if (!state) return show_that_it_is_gone();
    gone_ = false;
    const std::string summary = summary_of(*state);
    if (summary == shown_) return;
    shown_ = summary;
    question_.show(step_that_asks(*state), Steady::now());
    print_out("{}\n", options_.json ? json_text(json_of(*state)) : table_of(*state));
    if (const std::string asks = step_that_asks(*state); !asks.empty() && !options_.json) {
      print_out("c(onfirm) '{}', p(ause), b(ack), a(bort)?\n", terminal_text(asks));
    }
    std::fflush(standard_output());
  }

  /// A question of a task that is gone waits for no answer.
  void show_that_it_is_gone() {
    if (!link_->tasks().empty() || std::exchange(shown_, {}).empty()) return;
    gone_ = true;
    question_.show("", Steady::now());
    fmt::print(stderr, "armature: the task of '{}' is gone\n", deployment_.name);
  }

  /// Shows every change, and says what is typed, until the end of input. Who sits at a terminal has
  /// seen what became of his words: kOk. A script is told the worst of it.
  int listen() {
    if (!options_.json) {
      print_out("a word or its letter, and Enter: {}; q leaves, and changes nothing\n",
                fmt::join(kOperatorWords, ", "));
    }
    int worst = kOk;
    std::string line;
    for (bool told = false; !g_left;) {
      show_if_changed();
      if (link_->tasks().size() > 1 && !std::exchange(told, true)) is_ambiguous();
      if (!read_line(line)) continue;
      if (without_blanks(line) == "q" || ended_) break;
      worst = std::max(worst, answer(line));
    }
    return is_terminal_ ? kOk : worst;
  }

 private:
  /// Whoever waits for the word to have an effect must know that it had none.
  static int left_before(const std::string& word) {
    fmt::print(stderr, "armature: interrupted before {} was said\n",
               word.empty() ? "a word" : "'" + word + "'");
    return kFailed;
  }

  /// Says a line that was typed; the exit code is the one of --say.
  int answer(const std::string& typed) {
    const std::string line{without_blanks(typed)};
    if (line.empty()) return kOk;
    const std::string word = word_of(line);
    if (!word.empty() && gone_) {
      fmt::print(stderr, "armature: the task is gone, and nobody has heard '{}'\n", word);
      return kFailed;
    }
    if (word == "confirm") return confirm();
    if (!word.empty()) return say(word, "");
    fmt::print(stderr, "armature: '{}' is no word of an operator\n", line);
    return kUsage;
  }

  /// A confirmation is of the step that stands on the screen, whatever waits by now.
  int confirm() {
    const auto step = question_.confirmed(Steady::now());
    if (step) return say("confirm", *step);
    fmt::print(stderr, "armature: {}\n", terminal_text(step.error().text));
    return kFailed;
  }

  /// Which of several is the task cannot be known: nothing is said to any of them.
  bool is_ambiguous() const {
    if (link_->tasks().size() < 2) return false;
    fmt::print(stderr,
               "armature: {} writers say that they are the task of deployment '{}', and no word is "
               "said to any: {}. End the one that is not meant, or give each a domain of its own; "
               "`armature stop` stops every arm meanwhile\n",
               link_->tasks().size(), deployment_.name, fmt::join(link_->tasks(), ", and "));
    return true;
  }

  /// Whoever has not looked for some time, as he was halted or his laptop slept, is lost to the
  /// task and it to him, and not always do they find each other again: he meets it anew.
  void look() {
    constexpr Duration kLost = seconds(0.5);  // half of what a silent program is waited for
    const Duration stood_still = since_boot() - looked_at_;
    if (stood_still > kLost) {
      fmt::print(stderr,
                 "armature: this dialogue stood still for {:.1f} s; it meets the task anew\n",
                 to_seconds(stood_still));
      shown_.clear();
      question_.show("", Steady::now());
      gone_ = true;  // until it tells what it does
      rejoin();
    }
    looked_at_ = since_boot();
    link_->look();
  }

  /// Tries until it can, or he leaves: the network of a laptop that wakes up takes a while.
  void rejoin() {
    constexpr milliseconds kTryAgain{200};
    for (std::string told; !g_left; std::this_thread::sleep_for(kTryAgain)) {
      try {
        link_ = join_();
        return;
      } catch (const PluginError& error) {
        if (told != error.what()) fmt::print(stderr, "armature: {}; trying again\n", error.what());
        told = error.what();
      }
    }
  }

  template <class Done>
  bool wait(const Done& done) {
    const auto give_up = Steady::now() + seconds(options_.timeout_s);
    while (!g_left && Steady::now() < give_up) {
      look();
      if (done()) return true;
      std::this_thread::sleep_for(kAskAgain);
    }
    return false;
  }

  /// True when a line was typed, or none will be any more. The last line of a file needs no end; at
  /// a terminal nothing is said without Enter.
  bool read_line(std::string& line) {
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (poll(&input, 1, static_cast<int>(kAskAgain.count())) <= 0) return false;
    char letter = 0;
    const ssize_t count = read(STDIN_FILENO, &letter, 1);
    if (count > 0 && letter != '\n') {
      typed_ += letter;
      return false;
    }
    ended_ = count < 0 || (count == 0 && (is_terminal_ || typed_.empty()));
    line = std::exchange(typed_, {});
    return true;
  }

  const OperatorOptions& options_;
  const DeploymentConfig& deployment_;
  const Join join_;
  std::unique_ptr<TaskLink> link_;
  Duration looked_at_ = since_boot();
  std::mt19937_64 ids_{std::random_device{}()};
  std::string shown_, typed_;
  ShownQuestion question_;
  const bool is_terminal_ = isatty(STDIN_FILENO) == 1;
  bool ended_ = false, gone_ = false;
};

/// What the file says and what the options add to it.
NetworkOptions network_of(const OperatorOptions& options, const DeploymentConfig& deployment) {
  NetworkOptions network = deployment.dds.network(options.domain.value_or(deployment.domain));
  const NetworkOptions& more = options.network;
  std::ranges::copy(more.interfaces, std::back_inserter(network.interfaces));
  std::ranges::copy(more.peers, std::back_inserter(network.peers));
  if (!more.discovery_server.empty()) network.discovery_server = more.discovery_server;
  network.shared_memory = network.shared_memory && more.shared_memory;
  return network;
}

}  // namespace

int be_operator(const OperatorOptions& options) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
    std::signal(signal, [](int) { g_left = true; });
  }
  PluginRegistry plugins;
  const DeploymentConfig deployment = read_named(options.source, plugins);
  const TaskTopics topics = find_task(deployment, options.component);
  const NetworkOptions network = network_of(options, deployment);
  Dialogue dialogue{options, deployment,
                    [&] { return std::make_unique<TaskLink>(plugins, topics, network); }};
  if (const int code = dialogue.meet(); code != kOk) return code;
  if (options.say.empty()) return dialogue.listen();
  const auto step = options.say == "confirm" ? dialogue.step_meant(options.step) : options.step;
  if (!step) {
    fmt::print(stderr, "armature: 'confirm' was not said: {}\n", step.error().text);
    return kFailed;
  }
  const int code = dialogue.say(options.say, *step);
  dialogue.show_if_changed();
  return code;
}

}  // namespace armature
