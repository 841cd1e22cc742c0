// SPDX-License-Identifier: Apache-2.0
#include "verify.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "allocations.hpp"
#include "armature/kinds/ik/lines/asking.hpp"
#include "armature/kinds/ik/verify/plugin_subject.hpp"
#include "armature/runtime/plugin_registry.hpp"
#include "exit_code.hpp"
#include "isolated.hpp"
#include "plugins.hpp"
#include "shipped_configs.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The library or id of the command line.
struct Choice {
  std::vector<fs::path> search_path;
  std::string id;
  std::string environment;  // what the shell must set to find it again
};

bool is_same(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return fs::equivalent(a, b, error);
}

Choice choose(const std::string& plugin) {
  Choice choice{PluginRegistry::default_search_path(), plugin, ""};
  if (!fs::is_regular_file(plugin)) return choice;
  const fs::path file = fs::canonical(plugin);
  choice.search_path.insert(choice.search_path.begin(), file.parent_path());
  choice.environment = fmt::format("ARMATURE_PLUGIN_PATH={} ", file.parent_path().string());
  const PluginRegistry plugins{choice.search_path};
  for (const PluginManifest& found : plugins.plugins()) {
    if (is_same(found.file, file)) choice.id = found.id;
  }
  for (const auto& [unusable, reason] : plugins.unusable()) {
    if (is_same(unusable, file)) {
      throw PluginError(fmt::format("{} cannot be used: {}", plugin, reason));
    }
  }
  return choice;
}

/// A question in memory that parent and child share: the last one before a crash.
class LastQuestion {
 public:
  LastQuestion() {
    void* memory =
        mmap(nullptr, sizeof(Question), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc{};
    question_ = new (memory) Question{};
  }
  ~LastQuestion() { munmap(question_, sizeof(Question)); }
  LastQuestion(const LastQuestion&) = delete;
  LastQuestion& operator=(const LastQuestion&) = delete;

  void set(const IkGoal& goal, const JointVector& seed, bool redundancy_is_length) {
    *question_ = {goal, seed, redundancy_is_length, true};
  }
  void forget() { *question_ = {}; }
  std::string line(const RobotModel& model) const {
    if (!question_->asked) return "";
    return question_line(model, {.goal = question_->goal,
                                 .seed = question_->seed,
                                 .redundancy_is_length = question_->redundancy_is_length,
                                 .id = {}});
  }

 private:
  struct Question {
    IkGoal goal;
    JointVector seed;
    bool redundancy_is_length = false;
    bool asked = false;
  };
  Question* question_;
};

Json report_json(const IkLawReport& report) {
  Json json{{"skipped", report.skipped},
            {"note", report.note},
            {"questions", report.goals},
            {"failed", report.failed}};
  json["violations"] = Json::array();
  for (const auto& [what, question] : report.violations) {
    json["violations"].push_back({{"what", what}, {"question", question}});
  }
  return json;
}

/// One plugin with one robot.
class Verification {
 public:
  Verification(const VerifyOptions& options, const Choice& choice, ArmChoice arm)
      : options_{options},
        choice_{choice},
        arm_{std::move(arm)},
        model_{std::make_shared<const RobotModel>(load_arm(arm_))},
        plugins_{choice.search_path},
        plugin_{*plugins_.find(choice.id)},
        params_{params_of(plugin_, options.params)} {}

  /// The outcome of every law in order; `tell` is called after each.
  template <class Tell>
  Json run(Tell tell) {
    Json result{{"robot", model_->name()}, {"file", arm_.robot}};
    const Json made = outcome("the robot is served", [&] { return Json{{"refused", refusal()}}; });
    result["refused"] = made.value("refused", "");
    result["laws"] = Json::array();
    const auto keep = [&](Json law) {
      tell(law);
      result["laws"].push_back(std::move(law));
    };
    if (made["result"] == "fail") keep(made);
    if (made["result"] == "fail" || result["refused"] != "") return result;
    for (const IkLaw& law : ik_laws()) {
      keep(outcome(law.says, [&] {
        const IkSubject tried = subject();
        return report_json(check_law(law, tried, tools(*tried.solver)));
      }));
    }
    keep(outcome(IkLoadingLaw::kSays, [&] {
      return report_json(check_loading(choice_.search_path, choice_.id, *model_, params_));
    }));
    return result;
  }

 private:
  /// Why the plugin does not serve the robot; empty when it does.
  std::string refusal() {
    const auto made = plugin_subject(plugins_, plugin_, model_, params_);
    return made ? "" : made.error().text;
  }
  IkSubject subject() {
    auto made = plugin_subject(plugins_, plugin_, model_, params_);
    if (!made) throw std::runtime_error("refused this time: " + made.error().text);
    made->poses = 2 * options_.poses;
    made->edge_poses = options_.poses;
    made->seed = options_.seed;
    return *made;
  }
  IkLawTools tools(const IkSolver& solver) {
    return {.allocations = allocation_counter(),
            .before_solve = [this, is_length = solver.redundancy_is_length()](
                                const IkGoal& goal, const JointVector& seed) {
              last_.set(goal, seed, is_length);
            }};
  }

  /// Does `check` in a child process and says how it went.
  template <class Check>
  Json outcome(std::string_view says, Check check) {
    using Clock = std::chrono::steady_clock;
    last_.forget();
    const auto start = Clock::now();
    const Isolated done = isolated(options_.patience_s, [&] { return check().dump(); });
    Json law{{"law", says}};
    law["result"] = "pass";
    law["violations"] = Json::array();
    law["seconds"] = std::chrono::duration<double>{Clock::now() - start}.count();
    if (done.fault.empty()) {
      law.update(Json::parse(done.result));
      if (law.value("failed", 0) > 0) law["result"] = "fail";
      if (law.value("skipped", "") != "") law["result"] = "skip";
    } else {
      law["result"] = "fail";
      law["violations"].push_back({{"what", done.fault}, {"question", last_.line(*model_)}});
    }
    for (Json& violation : law["violations"]) {
      violation["reproduce"] = command_for(violation["question"].get<std::string>());
      violation.erase("question");
    }
    return law;
  }

  std::string command_for(const std::string& question) const {
    if (question.empty()) return "";
    std::string command = fmt::format("echo '{}' | {}armature ik --robot '{}'", question,
                                      choice_.environment, arm_.robot);
    if (!arm_.tip.empty()) command += fmt::format(" --tip '{}'", arm_.tip);
    if (!arm_.base.empty()) command += fmt::format(" --base '{}'", arm_.base);
    if (!options_.params.empty()) command += fmt::format(" --params '{}'", options_.params);
    return command + " --plugin " + choice_.id;
  }

  const VerifyOptions& options_;
  const Choice& choice_;
  ArmChoice arm_;
  std::shared_ptr<const RobotModel> model_;
  PluginRegistry plugins_;
  const PluginManifest& plugin_;
  Params params_;
  LastQuestion last_;
};

void print_law(const Json& law) {
  const std::string result = law["result"];
  std::string remark = result == "skip" ? law.value("skipped", "") : law.value("note", "");
  if (result == "fail" && law.contains("failed")) {
    remark = fmt::format("{} of {} answers{}{}", law["failed"].get<int>(),
                         law["questions"].get<int>(), remark.empty() ? "" : "; ", remark);
  }
  fmt::print("  {:<4}  {:<46} {:>6.2f} s  {}\n", result == "fail" ? "FAIL" : result,
             law["law"].get<std::string>(), law["seconds"].get<double>(), remark);
  for (const Json& violation : law["violations"]) {
    fmt::print("          {}\n", violation["what"].get<std::string>());
    const std::string command = violation["reproduce"];
    if (!command.empty()) fmt::print("          {}\n", command);
  }
  std::fflush(stdout);
}

bool kept(const Json& robot) {
  for (const Json& law : robot["laws"]) {
    if (law["result"] == "fail") return false;
  }
  return true;
}

std::vector<ArmChoice> arms_of(const VerifyOptions& options) {
  if (!options.arm.robot.empty()) return {options.arm};
  std::vector<ArmChoice> arms;
  for (const fs::path& file : shipped_robots())
    arms.push_back({file.string(), options.arm.tip, options.arm.base});
  return arms;
}

}  // namespace

int verify_plugin(const VerifyOptions& options) {
  const Choice choice = choose(options.plugin);
  const PluginRegistry plugins{choice.search_path};
  tell_warnings(plugins);
  const PluginManifest* plugin = plugins.find(choice.id);
  if (!plugin) throw InvalidChoice(plugins.unknown_text(choice.id));
  if (plugin->kind != IkSolver::kKind) {
    throw InvalidChoice(fmt::format("'{}' is of kind '{}'; there are laws to verify for kind 'ik'",
                                    plugin->id, plugin->kind));
  }
  if (const std::string wrong = wrong_offers(*plugin); !wrong.empty()) throw InvalidChoice(wrong);
  Json all{{"plugin", plugin->id}, {"library", plugin->file.string()}};
  all["robots"] = Json::array();
  int served = 0;
  bool ok = true;
  for (const ArmChoice& arm : arms_of(options)) {
    Verification verification{options, choice, arm};
    if (!options.json) fmt::print("{} with {}\n", plugin->id, arm.robot);
    const Json robot = verification.run([&](const Json& law) {
      if (!options.json) print_law(law);
    });
    const std::string refused = robot["refused"];
    if (!options.json && !refused.empty()) fmt::print("  not served: {}\n", refused);
    if (refused.empty()) ++served;
    ok = ok && kept(robot);
    all["robots"].push_back(robot);
  }
  all["ok"] = ok = ok && served > 0;
  if (options.json) fmt::print("{}\n", all.dump());
  if (served == 0) fmt::print(stderr, "armature: {} serves none of these robots\n", plugin->id);
  return ok ? kOk : kFailed;
}

}  // namespace armature
