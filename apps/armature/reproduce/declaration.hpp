// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "armature/config/node.hpp"

namespace armature::reproduce {

/// A number with the text that a paper printed: its last digit says how far it was rounded.
struct Printed {
  std::string text;
  double value = 0;
  /// One of the last printed digit: 0.001 of "1.234".
  double last_digit() const;
};

/// One line of a table: what the paper prints, what its own numbers give when they are computed in
/// double precision, and what ours may be.
struct DeclaredRow {
  std::string name, unit;
  std::optional<Printed> printed;           // none: the paper does not say
  std::optional<double> recomputed;         // none: the paper does not give enough
  double tolerance = 0;                     // of ours against the recomputed value
  std::optional<double> at_least, at_most;  // of ours
  double rounding = 0;                      // of the recomputed against the printed value
  std::string differs;   // why ours is another number than the printed one; "": it is the same
  std::string misprint;  // what is wrong with the printed value; "": it is right
};

struct DeclaredTable {
  std::string name, title, source;
  bool is_long = false;  // takes more than a few seconds
  std::vector<DeclaredRow> rows;
};

struct DeclaredFigure {
  std::string name, title, source;
  std::string x;                    // label with unit
  std::vector<std::string> panels;  // labels with units
  bool is_equal = false;            // of places: both axes to one scale
  bool is_long = false;             // takes more than a few seconds
};

/// The file docs/papers/<paper>.yaml: what `armature reproduce` shows of a paper.
struct Declaration {
  std::string paper;
  config::Node numbers;  // the paper's own, which the computation starts from
  std::vector<DeclaredTable> tables;
  std::vector<DeclaredFigure> figures;
};

/// Throws config::ConfigError with every problem.
Declaration read_declaration(const config::Node& file);

}  // namespace armature::reproduce
