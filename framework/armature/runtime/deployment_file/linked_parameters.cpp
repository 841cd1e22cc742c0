// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment_file/linked_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "armature/runtime/deployment_file/graph.hpp"

namespace armature {
namespace {

bool has_param(const ComponentConfig& component, std::string_view name) {
  return std::ranges::find(component.manifest->params, name, &ParamSpec::name) !=
         component.manifest->params.end();
}

/// Whether `reader` reads what `writer` writes on its output of that name.
bool reads(const ComponentConfig& reader, const ComponentConfig& writer, std::string_view output) {
  return std::ranges::any_of(writer.outputs, [&](const PortBinding& out) {
    return out.spec.name == output && has_topic(reader.inputs, out.topic);
  });
}

/// Whether the parameter of `component` is to be the same as that of `other`: of a plugin with
/// which it exchanges topics, "task/mine", or of whoever reads one of its outputs, "goal.depth_mm".
bool is_meant(const ParamSpec& spec, const ComponentConfig& component,
              const ComponentConfig& other) {
  const std::string_view same_as = spec.same_as;
  const std::size_t dot = same_as.find('.');
  if (dot == std::string_view::npos) {
    return same_as == other.plugin_id && exchange_topics(component, other);
  }
  return other.unit == kMainUnit && reads(other, component, same_as.substr(0, dot)) &&
         has_param(other, spec.name);
}

/// Where a number stands, or that it is a default.
std::string place_of(const Params& params, std::string_view name) {
  return params.is_written(name) ? params.origin(name).text() : "its default";
}

void check_at_most(const ComponentConfig& component, const ParamSpec& spec,
                   const DeploymentConfig& deployment, config::Problems& problems) {
  const std::string_view at_most = spec.at_most;
  const std::size_t dot = at_most.find('.');
  if (dot == std::string_view::npos) return;  // of a parameter of its own, which is checked there
  const std::string_view output = at_most.substr(0, dot), limit = at_most.substr(dot + 1);
  for (const ComponentConfig& reader : deployment.components) {
    if (reader.unit != kMainUnit || !reads(reader, component, output)) continue;
    if (!has_param(reader, limit)) continue;
    const double value = component.params.number(spec.name), most = reader.params.number(limit);
    const bool is_none = most == 0 && spec.min.value_or(0) > 0;
    if (value <= most || is_none) continue;
    const bool own = component.params.is_written(spec.name);
    const bool is_other_written = reader.params.is_written(limit);
    const config::Origin& place = own                ? component.params.origin(spec.name)
                                  : is_other_written ? reader.params.origin(limit)
                                                     : component.origin;
    problems.add(
        place, fmt::format("'{}' of component '{}' is {:g} ({}), above '{}' of component '{}', "
                           "which is {:g} ({}){}{}; lower the first or raise the second",
                           spec.name, component.name, value, place_of(component.params, spec.name),
                           limit, reader.name, most, place_of(reader.params, limit),
                           spec.otherwise.empty() ? "" : ": ", spec.otherwise));
  }
}

}  // namespace

void link_parameters(DeploymentConfig& deployment, config::Problems& problems) {
  for (ComponentConfig& component : deployment.components) {
    for (const ParamSpec& spec : component.manifest->params) {
      if (!spec.at_most.empty() && component.unit == kMainUnit) {
        check_at_most(component, spec, deployment, problems);
      }
      for (const ComponentConfig& other : deployment.components) {
        if (spec.same_as.empty() || !is_meant(spec, component, other)) continue;
        if (component.params.agree(spec.name, other.params)) continue;
        problems.add(component.params.origin(spec.name),
                     fmt::format("'{}' of component '{}' must be the same as that of component "
                                 "'{}', and is not; leave one of them out, or make them equal",
                                 spec.name, component.name, other.name));
      }
    }
  }
}

}  // namespace armature
