// SPDX-License-Identifier: Apache-2.0
#include "verify.hpp"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "armature/runtime/plugins/plugin_registry.hpp"
#include "armature/runtime/plugins/processor_level.hpp"
#include "armature/values/json_text.hpp"
#include "colour.hpp"
#include "exit_code.hpp"
#include "inspect/plugins.hpp"
#include "isolated.hpp"
#include "plugin_laws.hpp"
#include "shell_word.hpp"
#include "standard_output.hpp"
#include "verbs/shipped_configs.hpp"

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
  std::error_code none;
  if (!fs::is_regular_file(plugin, none)) return choice;
  const fs::path file = fs::canonical(plugin);
  const fs::path of_this_processor = library_for(processor_level(), file);  // which does its work
  const auto is_meant = [&](const fs::path& found) {
    return is_same(found, file) || is_same(found, of_this_processor);
  };
  choice.search_path.insert(choice.search_path.begin(), file.parent_path());
  choice.environment =
      fmt::format("ARMATURE_PLUGIN_PATH={} ", shell_word(file.parent_path().string()));
  const PluginRegistry plugins{choice.search_path};
  for (const PluginManifest& found : plugins.plugins()) {
    if (is_meant(found.file)) choice.id = found.id;
  }
  for (const auto& [unusable, reason] : plugins.unusable()) {
    if (is_meant(unusable)) {
      throw PluginError(fmt::format("{} cannot be used: {}", plugin, reason));
    }
  }
  return choice;
}

Json report_json(const LawReport& report) {
  Json json{{"skipped", report.skipped},
            {"note", report.note},
            {"questions", report.questions},
            {"failed", report.failed}};
  json["violations"] = Json::array();
  for (const auto& [what, question] : report.violations) {
    json["violations"].push_back({{"what", what}, {"question", question}});
  }
  return json;
}

/// Checks the laws of one plugin, each in a process of its own.
class Verification {
 public:
  Verification(PluginLaws& laws, double timeout_s) : laws_{laws}, timeout_s_{timeout_s} {}

  /// The outcome of every law in order; `tell` is called after each.
  template <class Tell>
  Json run(Tell tell) {
    Json result;
    const Json made = outcome("it can be made", [&] { return Json{{"refused", laws_.refusal()}}; });
    result["refused"] = made.value("refused", "");
    result["laws"] = Json::array();
    const auto keep = [&](Json law) {
      tell(law);
      result["laws"].push_back(std::move(law));
    };
    if (made["result"] == "fail") keep(made);
    if (made["result"] == "fail" || result["refused"] != "") return result;
    for (const LawRun& law : laws_.laws()) {
      keep(outcome(law.says, [&] { return report_json(law.check()); }));
    }
    return result;
  }

 private:
  /// Does `check` in a child process and says how it went.
  template <class Check>
  Json outcome(std::string_view says, Check check) {
    using Clock = std::chrono::steady_clock;
    laws_.forget_question();
    const auto start = Clock::now();
    const Isolated done = isolated(timeout_s_, [&] { return json_text(check()); });
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
      law["violations"].push_back({{"what", done.fault}, {"question", laws_.last_question()}});
    }
    for (Json& violation : law["violations"]) {
      violation["reproduce"] = laws_.command_for(violation["question"].get<std::string>());
      if (violation["reproduce"] != "") violation.erase("question");
    }
    return law;
  }

  PluginLaws& laws_;
  double timeout_s_;
};

void print_law(const Json& law) {
  const std::string result = law["result"];
  std::string remark = result == "skip" ? law.value("skipped", "") : law.value("note", "");
  if (result == "fail" && law.contains("failed")) {
    remark = fmt::format("{} of {} answers{}{}", law["failed"].get<int>(),
                         law["questions"].get<int>(), remark.empty() ? "" : "; ", remark);
  }
  const Tone tone = result == "fail" ? Tone::bad : result == "skip" ? Tone::doubtful : Tone::good;
  print_out(
      "  {}  {:<46} {:>6.2f} s  {}\n",
      coloured(fmt::format("{:<4}", result == "fail" ? "FAIL" : result), tone, standard_output()),
      law["law"].get<std::string>(), law["seconds"].get<double>(), remark);
  for (const Json& violation : law["violations"]) {
    print_out("          {}\n", violation["what"].get<std::string>());
    std::string again = violation["reproduce"];
    if (again.empty()) again = violation["question"];
    if (!again.empty()) print_out("          {}\n", again);
  }
  std::fflush(standard_output());
}

bool kept(const Json& robot) {
  for (const Json& law : robot["laws"]) {
    if (law["result"] == "fail") return false;
  }
  return true;
}

/// With which arms it is tried: one without a robot for a plugin that is made for none.
std::vector<ArmChoice> arms_of(const VerifyOptions& options, const PluginManifest& plugin) {
  if (!is_made_for_robot(plugin)) return {ArmChoice{}};
  if (!options.arm.robot.empty()) return {options.arm};
  std::vector<ArmChoice> arms;
  for (const fs::path& file : shipped_robots()) {
    arms.push_back({file.string(), options.arm.tip, options.arm.base});
  }
  return arms;
}

}  // namespace

int verify_plugin(const VerifyOptions& options) {
  const Choice choice = choose(options.plugin);
  const PluginRegistry plugins{choice.search_path};
  tell_warnings(plugins);
  const PluginManifest* plugin = plugins.find(choice.id);
  if (!plugin) throw InvalidChoice(plugins.unknown_text(choice.id));
  Json all{{"plugin", plugin->id}, {"library", plugin->file.string()}};
  all["robots"] = Json::array();
  int served = 0;
  bool ok = true;
  for (const ArmChoice& arm : arms_of(options, *plugin)) {
    const auto laws = laws_of({.options = options,
                               .search_path = choice.search_path,
                               .id = plugin->id,
                               .arm = arm,
                               .environment = choice.environment});
    if (!options.json) {
      print_out("{}{}{}\n", plugin->id, arm.robot.empty() ? "" : " with ", arm.robot);
    }
    Json robot{{"robot", arm.robot.empty() ? "" : load_arm(arm).name()}, {"file", arm.robot}};
    robot.update(Verification{*laws, options.timeout_s}.run([&](const Json& law) {
      if (!options.json) print_law(law);
    }));
    const std::string refused = robot["refused"];
    if (!options.json && !refused.empty()) print_out("  not served: {}\n", refused);
    if (refused.empty()) ++served;
    ok = ok && kept(robot);
    all["robots"].push_back(robot);
  }
  all["ok"] = ok = ok && served > 0;
  if (options.json) print_out("{}\n", json_text(all));
  if (served == 0) {
    fmt::print(stderr, "armature: {} {}\n", plugin->id,
               is_made_for_robot(*plugin) ? "serves none of these robots" : "cannot be made");
  }
  return ok ? kOk : kFailed;
}

}  // namespace armature
