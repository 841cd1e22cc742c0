// SPDX-License-Identifier: Apache-2.0
#include "reproduce/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace armature::reproduce {
namespace {

/// Why ours does not hold, or "".
std::string fault_of_ours(const DeclaredRow& row, double ours) {
  if (!std::isfinite(ours)) return "ours is no number";
  if (row.recomputed && std::abs(ours - *row.recomputed) > row.tolerance) {
    return fmt::format("ours is {:.3g} from the recomputed value, {:.3g} allowed",
                       std::abs(ours - *row.recomputed), row.tolerance);
  }
  if (row.at_least && ours < *row.at_least) return fmt::format("at least {:g}", *row.at_least);
  if (row.at_most && ours > *row.at_most) return fmt::format("at most {:g}", *row.at_most);
  return "";
}

/// Why the printed value is not what the declaration says of it, or "".
std::string fault_of_print(const DeclaredRow& row, double ours) {
  if (!row.printed) return "";
  const double off = std::abs(row.printed->value - row.recomputed.value_or(ours));
  const bool agrees = off <= row.rounding * (1 + 1e-9);
  if (!agrees && row.misprint.empty() && row.differs.empty()) {
    return fmt::format("{:.3g} from the printed value, and no misprint is named", off);
  }
  if (agrees && !row.misprint.empty()) return "a misprint is named, and the printed value is right";
  return "";
}

JudgedRow judge_row(const std::string& table, const DeclaredRow& row, const Results& results) {
  JudgedRow judged{.declared = row};
  try {
    judged.ours = results.value(table, row.name);
  } catch (const std::out_of_range&) {
    judged.ours = std::nan("");
    judged.fault = "not computed";
    return judged;
  }
  judged.fault = fault_of_ours(row, judged.ours);
  if (judged.fault.empty()) judged.fault = fault_of_print(row, judged.ours);
  return judged;
}

void find_undeclared(const Declaration& declaration, const Results& results, bool with_long,
                     std::vector<std::string>& faults) {
  for (const auto& [table, rows] : results.values()) {
    const auto declared = std::ranges::find(declaration.tables, table, &DeclaredTable::name);
    for (const auto& [row, value] : rows) {
      if (declared == declaration.tables.end() ||
          std::ranges::find(declared->rows, row, &DeclaredRow::name) == declared->rows.end()) {
        faults.push_back(
            fmt::format("'{}' of {} was computed, and nothing declares it", row, table));
      }
    }
  }
  for (const auto& [figure, curves] : results.curves()) {
    const auto declared = std::ranges::find(declaration.figures, figure, &DeclaredFigure::name);
    if (declared == declaration.figures.end()) {
      faults.push_back(fmt::format("{} was computed, and nothing declares it", figure));
    }
  }
  for (const DeclaredFigure& figure : declaration.figures) {
    const bool is_asked = with_long || !figure.is_long;
    if (is_asked && !results.curves().contains(figure.name)) {
      faults.push_back(fmt::format("{} was not computed", figure.name));
    }
  }
}

template <class Matches>
int count_rows(const std::vector<JudgedTable>& tables, Matches matches) {
  std::ptrdiff_t count = 0;
  for (const JudgedTable& table : tables) count += std::ranges::count_if(table.rows, matches);
  return static_cast<int>(count);
}

}  // namespace

std::optional<double> JudgedRow::difference() const {
  if (declared.recomputed) return ours - *declared.recomputed;
  if (declared.printed) return ours - declared.printed->value;
  return std::nullopt;
}

int Judgement::rows() const {
  return count_rows(tables, [](const JudgedRow&) { return true; });
}
int Judgement::failed() const {
  return count_rows(tables, [](const JudgedRow& row) { return !row.fault.empty(); }) +
         static_cast<int>(faults.size());
}
int Judgement::misprints() const {
  return count_rows(tables, [](const JudgedRow& row) { return !row.declared.misprint.empty(); });
}

int Judgement::differ() const {
  return count_rows(tables, [](const JudgedRow& row) { return !row.declared.differs.empty(); });
}

Judgement judge(const Declaration& declaration, const Results& results, bool with_long) {
  Judgement judgement;
  for (const DeclaredTable& table : declaration.tables) {
    if (table.is_long && !with_long) continue;
    JudgedTable judged{.declared = table, .rows = {}};
    for (const DeclaredRow& row : table.rows) {
      judged.rows.push_back(judge_row(table.name, row, results));
    }
    judgement.tables.push_back(std::move(judged));
  }
  find_undeclared(declaration, results, with_long, judgement.faults);
  return judgement;
}

}  // namespace armature::reproduce
