// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "colour.hpp"
#include "watch/seen_deployments.hpp"

namespace armature {

/// What the rows of the table are sorted by: the way of the data, or the greatest first.
enum class TopOrder { graph, name, state, processor, step, lateness, dropped };

/// What the operator wants to see.
struct TopView {
  TopOrder order = TopOrder::graph;
  bool reversed = false;
  std::string filter;  // only components with this in their name, plugin or process
};

struct TopLine {
  std::string text;
  std::optional<Tone> tone;
};

struct TopTable {
  std::string title;           // of the columns
  std::vector<TopLine> lines;  // for each deployment one, and for every component; and reasons
};

/// How the components of all deployments are, `now` on the monotonic clock.
TopTable top_table(const std::map<std::string, SeenDeployment>& seen, const TopView& view,
                   Time now);
/// The same, for programs: `[{"deployment", "run", "components": [...]}]`, in SI units.
nlohmann::ordered_json top_json(const std::map<std::string, SeenDeployment>& seen, Time now);

}  // namespace armature
