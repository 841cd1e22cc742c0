// SPDX-License-Identifier: Apache-2.0
#include "reproduce/declaration.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "armature/config/problems.hpp"
#include "armature/config/reader.hpp"

namespace armature::reproduce {
namespace {

using config::KeySpec;
using config::MapReader;
using config::Problems;
using Type = KeySpec::Type;

const std::vector<KeySpec> kRowKeys{
    {.name = "row", .type = Type::text, .doc = "Its name."},
    {.name = "unit", .type = Type::text, .doc = "Of its numbers.", .optional = true},
    {.name = "printed", .type = Type::section, .doc = "As in the paper.", .optional = true},
    {.name = "recomputed", .doc = "From the paper's own numbers.", .optional = true},
    {.name = "tolerance", .doc = "Of ours against it.", .optional = true, .above = 0},
    {.name = "rounding", .doc = "Of it against the printed one.", .min = 0, .optional = true},
    {.name = "at_least", .doc = "Of ours.", .optional = true},
    {.name = "at_most", .doc = "Of ours.", .optional = true},
    {.name = "differs",
     .type = Type::text,
     .doc = "Why ours is another number than the printed one.",
     .optional = true},
    {.name = "misprint",
     .type = Type::text,
     .doc = "What is wrong in the paper.",
     .optional = true}};
const std::vector<KeySpec> kTableKeys{
    {.name = "table", .type = Type::text, .doc = "Its name, and that of its file."},
    {.name = "title", .type = Type::text, .doc = "What it shows."},
    {.name = "source", .type = Type::text, .doc = "Where in the paper."},
    {.name = "long",
     .type = Type::flag,
     .doc = "Takes more than a few seconds.",
     .fallback = config::default_value("false")},
    {.name = "unit", .type = Type::text, .doc = "Of its rows.", .optional = true},
    {.name = "tolerance", .doc = "Of its rows.", .optional = true, .above = 0},
    {.name = "rounding", .doc = "Of its rows.", .min = 0, .optional = true},
    {.name = "differs", .type = Type::text, .doc = "Of its rows.", .optional = true},
    {.name = "rows", .type = Type::section, .doc = "Its lines."}};
const std::vector<KeySpec> kFigureKeys{
    {.name = "figure", .type = Type::text, .doc = "Its name, and that of its files."},
    {.name = "title", .type = Type::text, .doc = "What it shows."},
    {.name = "source", .type = Type::text, .doc = "Which one of the paper."},
    {.name = "x", .type = Type::text, .doc = "The label of the axis, with its unit."},
    {.name = "panels", .type = Type::texts, .doc = "The labels of the panels, with their units."},
    {.name = "equal",
     .type = Type::flag,
     .doc = "Of places: both axes to one scale.",
     .fallback = config::default_value("false")},
    {.name = "long",
     .type = Type::flag,
     .doc = "Takes more than a few seconds.",
     .fallback = config::default_value("false")}};
const std::vector<KeySpec> kFileKeys{
    {.name = "paper", .type = Type::text, .doc = "Who and what."},
    {.name = "numbers", .type = Type::section, .doc = "The paper's own."},
    {.name = "tables", .type = Type::section, .doc = "What is compared."},
    {.name = "figures", .type = Type::section, .doc = "What is drawn."}};

std::optional<Printed> read_printed(MapReader& map) {
  const config::Node* node = map.node("printed");
  if (!node) return std::nullopt;
  Printed printed{.text = node->text()};
  std::size_t read = 0;
  try {
    printed.value = std::stod(printed.text, &read);
  } catch (const std::exception&) {
  }
  if (read == 0 || read != printed.text.size()) {
    map.problem("printed", node->describe() + " is no number");
  }
  return printed;
}

/// The values of a table that hold for its rows, until a row says otherwise.
struct Defaults {
  std::string unit;
  std::optional<double> tolerance, rounding;
  std::string differs;
};

DeclaredRow read_row(const config::Node& node, const Defaults& defaults, Problems& problems) {
  MapReader map{node, "row", kRowKeys, problems};
  DeclaredRow row;
  row.name = map.text("row");
  row.unit = map.text("unit");
  if (row.unit.empty()) row.unit = defaults.unit;
  row.printed = read_printed(map);
  row.recomputed = map.optional_number("recomputed");
  row.at_least = map.optional_number("at_least");
  row.at_most = map.optional_number("at_most");
  const auto tolerance = map.optional_number("tolerance");
  row.tolerance = tolerance.value_or(defaults.tolerance.value_or(0));
  const double last_digit = row.printed ? row.printed->last_digit() : 0;
  row.rounding = map.optional_number("rounding").value_or(defaults.rounding.value_or(last_digit));
  row.misprint = map.text("misprint");
  row.differs = map.text("differs");
  if (row.differs.empty() && row.printed) row.differs = defaults.differs;
  map.finish();
  const auto object = [&](const char* what) {
    problems.add(node.origin(), fmt::format("'{}' {}", row.name, what));
  };
  if (row.recomputed && !(row.tolerance > 0)) object("needs a tolerance");
  if (!row.recomputed && !row.at_least && !row.at_most) {
    object("cannot fail: give 'recomputed', 'at_least' or 'at_most'");
  }
  if (!row.misprint.empty() && !(row.printed && row.recomputed)) {
    object("names a misprint without 'printed' and 'recomputed'");
  }
  return row;
}

DeclaredTable read_table(const config::Node& node, Problems& problems) {
  MapReader map{node, "table", kTableKeys, problems};
  DeclaredTable table{.name = map.text("table"),
                      .title = map.text("title"),
                      .source = map.text("source"),
                      .is_long = map.flag("long"),
                      .rows = {}};
  const Defaults defaults{map.text("unit"), map.optional_number("tolerance"),
                          map.optional_number("rounding"), map.text("differs")};
  std::set<std::string> names;
  if (const config::Node* rows = map.node("rows")) {
    for (const config::Node& row : rows->items()) {
      table.rows.push_back(read_row(row, defaults, problems));
      if (!names.insert(table.rows.back().name).second) {
        problems.add(row.origin(),
                     fmt::format("'{}' is in this table twice", table.rows.back().name));
      }
    }
  }
  map.finish();
  return table;
}

DeclaredFigure read_figure(const config::Node& node, Problems& problems) {
  MapReader map{node, "figure", kFigureKeys, problems};
  DeclaredFigure figure{.name = map.text("figure"),
                        .title = map.text("title"),
                        .source = map.text("source"),
                        .x = map.text("x"),
                        .panels = map.optional_texts("panels").value_or(std::vector<std::string>{}),
                        .is_equal = map.flag("equal"),
                        .is_long = map.flag("long")};
  map.finish();
  return figure;
}

}  // namespace

double Printed::last_digit() const {
  const auto exponent = text.find_first_of("eE");
  const std::string digits = text.substr(0, exponent);
  const auto point = digits.find('.');
  const double decimals = point == std::string::npos ? 0.0 : double(digits.size() - point - 1);
  const double power = exponent == std::string::npos ? 0 : std::stod(text.substr(exponent + 1));
  return std::pow(10, power - decimals);
}

Declaration read_declaration(const config::Node& file) {
  Problems problems;
  MapReader map{file, "paper", kFileKeys, problems};
  Declaration declaration{.paper = map.text("paper"), .numbers = config::Node::null(file.origin())};
  if (const config::Node* numbers = map.node("numbers")) declaration.numbers = *numbers;
  if (const config::Node* tables = map.node("tables")) {
    for (const config::Node& table : tables->items()) {
      declaration.tables.push_back(read_table(table, problems));
    }
  }
  if (const config::Node* figures = map.node("figures")) {
    for (const config::Node& figure : figures->items()) {
      declaration.figures.push_back(read_figure(figure, problems));
    }
  }
  map.finish();
  std::set<std::string> names;  // of files
  for (const DeclaredTable& table : declaration.tables) names.insert(table.name);
  for (const DeclaredFigure& figure : declaration.figures) names.insert(figure.name);
  if (names.size() != declaration.tables.size() + declaration.figures.size()) {
    problems.add(file.origin(), "two tables or figures have one name, and would have one file");
  }
  problems.throw_if_any();
  return declaration;
}

}  // namespace armature::reproduce
