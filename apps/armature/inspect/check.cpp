// SPDX-License-Identifier: Apache-2.0
#include "inspect/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "armature/runtime/deployment/deployment.hpp"
#include "armature/runtime/deployment_file/component_config.hpp"
#include "armature/runtime/deployment_file/on_fault.hpp"
#include "armature/runtime/plugins/exit_guard.hpp"
#include "armature/runtime/plugins/running_component.hpp"
#include "armature/runtime/plugins/setup_error.hpp"
#include "armature/values/json_text.hpp"
#include "exit_code.hpp"
#include "inspect/origin_json.hpp"
#include "inspect/plugins.hpp"
#include "run/named_deployment.hpp"
#include "standard_output.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

/// A component that was read, and not constructed.
struct NotTried {
  std::string component, plugin;
};

/// A line that a component says of the deployment before it runs.
struct Note {
  std::string component, text;
};

/// What a check has found so far; what was found before a problem counts beside it.
struct Findings {
  std::string deployment;
  std::ptrdiff_t components = 0;
  std::size_t topics = 0;
  std::vector<std::string> plugin_warnings, warnings;
  std::vector<NotTried> not_tried;
  std::vector<Note> notes;
};

/// The plugin of the component, or of one of its slots, that starts a program which a parameter
/// names; nullptr: none does.
const PluginManifest* runs_programs(const ComponentConfig& component) {
  if (component.manifest->runs_programs) return component.manifest;
  const auto slot = std::ranges::find_if(
      component.slots, [](const SlotConfig& one) { return one.manifest->runs_programs; });
  return slot == component.slots.end() ? nullptr : slot->manifest;
}

/// Checking a file must not run what the file names.
void leave_out_programs(DeploymentConfig& deployment, Findings& findings) {
  std::erase_if(deployment.components, [&](const ComponentConfig& component) {
    const PluginManifest* plugin = runs_programs(component);
    if (plugin) findings.not_tried.push_back({component.name, plugin->id});
    return plugin != nullptr;
  });
}

std::size_t count_topics(const DeploymentConfig& deployment) {
  std::set<std::string_view> topics;
  for (const auto& component : deployment.components) {
    for (const auto& port : component.outputs) topics.insert(port.topic);
    for (const auto& port : component.inputs) topics.insert(port.topic);
  }
  return topics.size();
}

/// The deployment without what must not be tried. Throws the problems of its files.
DeploymentConfig read_for_check(const DeploymentSource& source, const PluginRegistry& plugins,
                                Findings& findings) {
  DeploymentConfig config = read_named(source, plugins, &findings.warnings);
  findings.deployment = config.name;
  findings.components = count_components(config);
  findings.topics = count_topics(config);
  leave_out_programs(config, findings);
  return config;
}

/// Constructing the components is how a solver gets to refuse its robot.
void construct(DeploymentConfig config, PluginRegistry& plugins, Findings& findings) {
  name_crashing_components();
  const Deployment constructed{std::move(config), plugins, {.process = ""}};
  for (const auto& warnings :
       {executor_warnings(constructed.config()), isolation_warnings(constructed.config())}) {
    findings.warnings.insert(findings.warnings.end(), warnings.begin(), warnings.end());
  }
  for (const auto& runner : constructed.runners()) {
    try {
      for (std::string& text : runner->notes_for_check()) {
        findings.notes.push_back({runner->name(), std::move(text)});
      }
    } catch (...) {
      throw SetupError{fmt::format("component '{}': its notes for check failed: {}", runner->name(),
                                   current_exception_text())};
    }
  }
}

/// Where the known names that are near begin in a message, outside of what it quotes; npos: there
/// are none.
std::size_t hint_in(std::string_view message) {
  const auto is_letter = [&](std::size_t i) {
    return i < message.size() && std::isalnum(static_cast<unsigned char>(message[i])) != 0;
  };
  bool is_quoted = false;
  for (std::size_t i = 0; i < message.size(); ++i) {
    const std::string_view rest = message.substr(i);
    if (message[i] == '\'' && !is_letter(is_quoted ? i + 1 : i - 1)) {
      is_quoted = !is_quoted;
    } else if (!is_quoted &&
               (rest.starts_with("; did you mean ") || rest.starts_with("; known: "))) {
      return i;
    }
  }
  return std::string_view::npos;
}

/// Where it is, what it is, and apart the known names that are near.
Json problem_json(const config::Problem& problem) {
  Json json = origin_json(problem.origin);
  const std::string& message = problem.message;
  const std::size_t end = hint_in(message);
  json["text"] = message.substr(0, end);
  if (end != std::string::npos) json["hint"] = message.substr(end + 2);
  return json;
}

Json problems_json(const std::exception& error) {
  Json list = Json::array();
  if (const auto* wrong = dynamic_cast<const config::ConfigError*>(&error)) {
    for (const config::Problem& problem : wrong->problems()) list.push_back(problem_json(problem));
  } else {
    list.push_back(problem_json({.origin = {}, .message = error.what()}));
  }
  return list;
}

Json findings_json(const Findings& findings, Json problems) {
  Json json{{"ok", problems.empty()}};
  if (problems.empty()) {
    json["deployment"] = findings.deployment;
    json["components"] = findings.components;
    json["topics"] = findings.topics;
  }
  json["problems"] = std::move(problems);
  std::vector<std::string> warnings = findings.plugin_warnings;
  warnings.insert(warnings.end(), findings.warnings.begin(), findings.warnings.end());
  json["warnings"] = std::move(warnings);
  json["notes"] = Json::array();
  for (const auto& [component, text] : findings.notes) {
    json["notes"].push_back({{"component", component}, {"text", text}});
  }
  json["not_tried"] = Json::array();
  for (const auto& [component, plugin] : findings.not_tried) {
    json["not_tried"].push_back({{"component", component}, {"runs_program", plugin}});
  }
  return json;
}

void print_json(const Findings& findings, Json problems) {
  print_out("{}\n", json_text(findings_json(findings, std::move(problems))));
}

int check_as_json(const DeploymentSource& source) {
  Findings findings;
  const ExitGuard guard{[&](const std::string& what) {
    print_json(findings, Json::array({Json{{"text", what}}}));
    std::fflush(standard_output());
  }};
  Json problems = Json::array();
  int code = kOk;
  try {
    PluginRegistry plugins;
    findings.plugin_warnings = plugins.warnings();
    construct(read_for_check(source, plugins, findings), plugins, findings);
  } catch (const std::exception& error) {
    problems = problems_json(error);
    code = exit_code_of(error);
  }
  print_json(findings, std::move(problems));
  return code;
}

}  // namespace

int check_deployment(const DeploymentSource& source, bool json) {
  if (json) return check_as_json(source);
  PluginRegistry plugins;
  tell_warnings(plugins);
  Findings findings;
  const auto tell_found = [&] {
    for (const std::string& warning : findings.warnings) {
      fmt::print(stderr, "warning: {}\n", warning);
    }
  };
  try {
    DeploymentConfig config = read_for_check(source, plugins, findings);
    for (const auto& [component, plugin] : findings.not_tried) {
      print_out("not tried: component '{}', as {} runs a program\n", component, plugin);
    }
    construct(std::move(config), plugins, findings);
  } catch (...) {
    tell_found();
    throw;
  }
  tell_found();
  print_out("{}: ok, {} components, {} topics\n", findings.deployment, findings.components,
            findings.topics);
  for (const auto& [component, text] : findings.notes) print_out("{}: {}\n", component, text);
  return kOk;
}

}  // namespace armature
