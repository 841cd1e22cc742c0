// SPDX-License-Identifier: Apache-2.0
#include "reproduce/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "armature/runtime/reporting/write_atomically.hpp"
#include "colour.hpp"
#include "csv_field.hpp"
#include "standard_output.hpp"

namespace armature::reproduce {
namespace {

constexpr FileUse kUse = FileUse::named_by_user;

/// With the digits that the tolerance leaves, and some.
std::string number_text(const std::optional<double>& value) {
  return value ? fmt::format("{:.8g}", *value) : "";
}

std::string bound_text(const DeclaredRow& row) {
  if (row.at_least && row.at_most) return fmt::format("{:g} to {:g}", *row.at_least, *row.at_most);
  if (row.at_most) return fmt::format("at most {:g}", *row.at_most);
  return row.at_least ? fmt::format("at least {:g}", *row.at_least) : "";
}

std::string remark_of(const JudgedRow& row) {
  if (!row.fault.empty()) return coloured("FAILS: " + row.fault, Tone::bad, standard_output());
  if (!row.declared.misprint.empty()) return "misprint: " + row.declared.misprint;
  const std::string bound = bound_text(row.declared);
  if (row.declared.differs.empty()) return bound;
  return bound + (bound.empty() ? "" : "; ") + "differs: " + row.declared.differs;
}

std::string table_text(const JudgedTable& table) {
  std::size_t width = 4;
  for (const JudgedRow& row : table.rows) width = std::max(width, row.declared.name.size());
  std::string text = fmt::format("{}: {} ({})\n", table.declared.name, table.declared.title,
                                 table.declared.source);
  text += fmt::format("  {:<{}}  {:>10}  {:>14}  {:>14}  {:>11}  {:<8}  \n", "row", width,
                      "printed", "recomputed", "ours", "difference", "unit");
  for (const JudgedRow& row : table.rows) {
    const auto difference = row.difference();
    text += fmt::format("  {:<{}}  {:>10}  {:>14}  {:>14}  {:>11}  {:<8}  {}\n", row.declared.name,
                        width, row.declared.printed ? row.declared.printed->text : "",
                        number_text(row.declared.recomputed), number_text(row.ours),
                        difference ? fmt::format("{:.2g}", *difference) : "", row.declared.unit,
                        remark_of(row));
  }
  return text;
}

std::string csv_of(const JudgedTable& table) {
  std::string csv = "row,unit,printed,recomputed,ours,tolerance,misprint,fault\r\n";
  for (const JudgedRow& row : table.rows) {
    const DeclaredRow& declared = row.declared;
    csv += fmt::format("{},{},{},{},{:.12g},{},{},{}\r\n", csv_field(declared.name),
                       csv_field(declared.unit), declared.printed ? declared.printed->text : "",
                       declared.recomputed ? fmt::format("{:.12g}", *declared.recomputed) : "",
                       row.ours, declared.recomputed ? fmt::format("{:g}", declared.tolerance) : "",
                       csv_field(declared.misprint), csv_field(row.fault));
  }
  return csv;
}

/// A point in a line, since not all curves have theirs in the same places.
std::string csv_of(const DeclaredFigure& figure, const std::vector<Results::Curve>& curves) {
  std::string csv = fmt::format("panel,curve,{},value\r\n", csv_field(figure.x));
  for (const Results::Curve& curve : curves) {
    const std::string& panel = figure.panels.at(curve.panel);
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      csv += fmt::format("{},{},{:.12g},{:.12g}\r\n", csv_field(panel), csv_field(curve.name),
                         curve.x[i], curve.y[i]);
    }
  }
  return csv;
}

plot::Chart chart_of(const DeclaredFigure& figure, const std::vector<Results::Curve>& curves) {
  plot::Chart chart{.title = figure.title, .x = {.label = figure.x}, .is_equal = figure.is_equal};
  for (const std::string& label : figure.panels) {
    chart.panels.push_back({.y = {.label = label}});
  }
  std::map<std::string, std::size_t> places;  // in the legend
  for (const Results::Curve& curve : curves) {
    const auto [place, is_new] = places.try_emplace(curve.name, chart.legend.size());
    if (is_new) {
      const auto look = curve.look == Results::Look::dots     ? plot::dots_of
                        : curve.look == Results::Look::dashed ? plot::dashed_line
                                                              : plot::line_of;
      chart.legend.push_back(look(chart.legend.size(), curve.name));
    }
    chart.panels.at(curve.panel).curves.push_back({place->second, curve.x, curve.y});
  }
  return chart;
}

}  // namespace

std::string to_text(const Declaration& declaration, const Judgement& judgement) {
  std::string text = declaration.paper + "\n\n";
  for (const JudgedTable& table : judgement.tables) text += table_text(table) + '\n';
  for (const std::string& fault : judgement.faults) {
    text += coloured("FAILS: " + fault, Tone::bad, standard_output()) + '\n';
  }
  const int failed_rows = judgement.failed() - static_cast<int>(judgement.faults.size());
  return text +
         fmt::format(
             "{} rows: {} hold, {} fail; {} misprints named, {} differ{}\n", judgement.rows(),
             judgement.rows() - failed_rows, failed_rows, judgement.misprints(), judgement.differ(),
             judgement.faults.empty() ? "" : fmt::format("; {} faults", judgement.faults.size()));
}

nlohmann::ordered_json to_json(const Declaration& declaration, const Judgement& judgement) {
  using Json = nlohmann::ordered_json;
  Json tables = Json::array();
  for (const JudgedTable& table : judgement.tables) {
    Json rows = Json::array();
    for (const JudgedRow& row : table.rows) {
      Json json{{"row", row.declared.name}, {"unit", row.declared.unit}};
      if (row.declared.printed) json["printed"] = row.declared.printed->value;
      if (row.declared.recomputed) json["recomputed"] = *row.declared.recomputed;
      json["ours"] = row.ours;
      if (row.declared.recomputed) json["tolerance"] = row.declared.tolerance;
      if (row.declared.at_least) json["at_least"] = *row.declared.at_least;
      if (row.declared.at_most) json["at_most"] = *row.declared.at_most;
      if (!row.declared.differs.empty()) json["differs"] = row.declared.differs;
      if (!row.declared.misprint.empty()) json["misprint"] = row.declared.misprint;
      if (!row.fault.empty()) json["fault"] = row.fault;
      rows.push_back(std::move(json));
    }
    tables.push_back({{"table", table.declared.name}, {"rows", std::move(rows)}});
  }
  return {{"paper", declaration.paper},   {"rows", judgement.rows()},
          {"failed", judgement.failed()}, {"misprints", judgement.misprints()},
          {"faults", judgement.faults},   {"tables", std::move(tables)}};
}

std::vector<std::string> write_files(const std::filesystem::path& folder,
                                     const Declaration& declaration, const Judgement& judgement,
                                     const Results& results) {
  std::vector<std::string> names;
  const auto write = [&](const std::string& name, const std::string& text) {
    write_atomically(folder / name, text, kUse);
    names.push_back(name);
  };
  for (const JudgedTable& table : judgement.tables) {
    write(table.declared.name + ".csv", csv_of(table));
  }
  for (const DeclaredFigure& figure : declaration.figures) {
    const auto curves = results.curves().find(figure.name);
    if (curves == results.curves().end()) continue;
    write(figure.name + ".csv", csv_of(figure, curves->second));
    write(figure.name + ".svg", plot::to_svg(chart_of(figure, curves->second)));
  }
  return names;
}

}  // namespace armature::reproduce
