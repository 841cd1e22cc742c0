// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reproduce/declaration.hpp"
#include "reproduce/results.hpp"

namespace armature::reproduce {

struct JudgedRow {
  DeclaredRow declared;
  double ours = 0;
  std::string fault;  // why it does not hold; "": it does
  /// Ours less the recomputed value, or less the printed one where nothing could be recomputed.
  std::optional<double> difference() const;
};

struct JudgedTable {
  DeclaredTable declared;
  std::vector<JudgedRow> rows;
};

/// The judged tables of a whole paper.
struct Judgement {
  std::vector<JudgedTable> tables;
  std::vector<std::string> faults;  // of what is declared or computed alone
  int rows() const;
  int failed() const;  // rows and faults
  int misprints() const;
  int differ() const;  // rows that are another number than the paper's, with the reason
};

/// Every declared row must have been computed and hold: ours within the tolerance of the
/// recomputed value, or within its bounds; the recomputed value within the rounding of the printed
/// one, or farther away where a misprint or the reason is named; ours stands for a value that could
/// not be recomputed. A value or a curve that nothing declares is a fault, too. `with_long`: tables
/// that take long were computed.
Judgement judge(const Declaration& declaration, const Results& results, bool with_long);

}  // namespace armature::reproduce
