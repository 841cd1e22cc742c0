// SPDX-License-Identifier: Apache-2.0
#include "inspect/leases.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <vector>

#include "armature/bus/qos.hpp"
#include "armature/runtime/deployment_file/on_fault.hpp"
#include "armature/runtime/execution/watchdog.hpp"

namespace armature {
namespace {

/// Who waits, for whom, at most, and then.
using Row = std::array<std::string, 4>;

std::string text_of(Duration time) { return fmt::format("{:g} s", to_seconds(time)); }

Duration time_of(const LeaseSpec& lease, const Params& params) {
  return lease.param.empty() ? lease.after : seconds(params.number(lease.param));
}

/// One end of a topic.
struct Writer {
  const ComponentConfig* component;
  const PortSpec* port;
};

std::string text_of(const Writer& writer) {
  return fmt::format("{} {}", writer.component->name, writer.port->name);
}

std::vector<Writer> writers_of(const PortBinding& input, const DeploymentConfig& deployment) {
  std::vector<Writer> writers;
  for (const ComponentConfig& component : deployment.components) {
    for (const PortBinding& output : component.outputs) {
      if (output.topic == input.topic) writers.push_back({&component, &output.spec});
    }
  }
  return writers;
}

/// Nothing for an input that nobody writes: the component has nobody to wait for.
void add_lease(const ComponentConfig& reader, const PortBinding& input,
               const DeploymentConfig& deployment, std::vector<Row>& rows) {
  if (!input.spec.lease) return;
  std::vector<std::string> names;
  for (const Writer& writer : writers_of(input, deployment)) names.push_back(text_of(writer));
  if (input.spec.outside) names.push_back("programs outside");
  if (names.empty()) return;
  rows.push_back({reader.name, fmt::format("{}", fmt::join(names, ", ")),
                  text_of(time_of(*input.spec.lease, reader.params)), input.spec.lease->then});
}

/// Commands from another process: DDS hears whether that process lives.
void add_liveliness(const ComponentConfig& reader, const PortBinding& input,
                    const DeploymentConfig& deployment, std::vector<Row>& rows) {
  if (input.spec.qos != QosProfile::command || input.spec.outside) return;
  for (const Writer& writer : writers_of(input, deployment)) {
    const std::string& process = writer.component->process;
    if (process == reader.process) continue;
    rows.push_back({reader.name, fmt::format("{} of process {}", text_of(writer), process),
                    text_of(settings(QosProfile::command).liveliness_lease.value()),
                    "it is told, and the run counts as failed: status fault"});
  }
}

/// In lockstep everything waits for a step.
std::string after_hang(const ComponentConfig& component, const DeploymentConfig& deployment) {
  if (deployment.simulated) return "it is told, and the run waits for the step";
  if (hang_stops_run(component, deployment)) return "the run stops";
  return "it is shown as stalled, and the run goes on";
}

void add_watchdog(const ComponentConfig& component, const DeploymentConfig& deployment,
                  std::vector<Row>& rows) {
  const auto max_step = declared_max_step(component, deployment);
  // Its period is known only when it has been constructed.
  const std::string otherwise = text_of(max_step_of({}, {})) + " or 3 periods";
  rows.push_back({"watchdog", "a step of " + component.name,
                  max_step ? text_of(*max_step) : otherwise, after_hang(component, deployment)});
}

std::vector<Row> rows_of(const DeploymentConfig& deployment) {
  std::vector<Row> rows{{"who waits", "for whom", "at most", "and then"}};
  for (const auto add : {add_lease, add_liveliness}) {
    for (const ComponentConfig& component : deployment.components) {
      for (const PortBinding& input : component.inputs) add(component, input, deployment, rows);
    }
  }
  for (const ComponentConfig& component : deployment.components) {
    add_watchdog(component, deployment, rows);
  }
  return rows;
}

}  // namespace

std::string leases_comment(const DeploymentConfig& deployment) {
  const std::vector<Row> rows = rows_of(deployment);
  std::array<std::size_t, 3> widths{};
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < widths.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& [who, whom, time, then] : rows) {
    text += fmt::format("# {:<{}}  {:<{}}  {:<{}}  {}\n", who, widths[0], whom, widths[1], time,
                        widths[2], then);
  }
  return text;
}

}  // namespace armature
