// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "armature/config/node.hpp"

namespace armature {
namespace config ARMATURE_EXPORT {

/// One thing that is wrong in a file, ready to print as `file:line:column: message`.
struct Problem {
  Origin origin;
  std::string message;

  std::string text() const;
};

/// Collects everything that is wrong, so that a user sees all of it at once.
class Problems {
 public:
  void add(const Origin& origin, std::string message);
  bool empty() const { return problems_.empty(); }
  /// In the order of files as first met, then line and column; equal problems once.
  std::vector<Problem> sorted() const;
  /// Throws ConfigError when there is any problem.
  void throw_if_any() const;

 private:
  std::vector<Problem> problems_;
};

/// Set-up failed because of what is written in configuration files. `what()` holds one line per
/// problem.
class ConfigError : public std::runtime_error {
 public:
  explicit ConfigError(std::vector<Problem> problems);
  std::span<const Problem> problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// `text` in single quotes on one line: control characters escaped, cut after 60 characters.
std::string in_quotes(std::string_view text);

/// "; did you mean 'a' or 'b'?" for the known names nearest to `wrong` (edit distance without case;
/// the same name with another unit suffix or under another family is nearest), or "" when none is
/// near.
std::string spelling_hint(std::string_view wrong, std::span<const std::string> known);

/// The spelling hint, or, when there is none, "; known: a, b, c" (at most eight), or "" when
/// nothing is known.
std::string did_you_mean(std::string_view wrong, std::span<const std::string> known);

}  // namespace config
}  // namespace armature
