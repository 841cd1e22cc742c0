// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "armature/config/key.hpp"

namespace armature {
namespace config ARMATURE_EXPORT {

/// A row of a table of keys, written as a sentence: the words below begin it with type, name and
/// doc, and each method adds what KeySpec has under the same name.
///     number("d_m", "Along z.").fallback("0").also("d_mm")
class KeyRow {
 public:
  KeyRow(KeySpec::Type type, std::string_view name, std::string_view doc)
      : key_{.name = std::string{name}, .type = type, .doc = std::string{doc}} {}
  operator KeySpec() const { return key_; }

  KeyRow& fallback(std::string_view text) {
    return with(&KeySpec::fallback, default_value(std::string{text}));
  }
  KeyRow& optional(bool is = true) { return with(&KeySpec::optional, is); }
  KeyRow& min(double least) { return with(&KeySpec::min, least); }
  KeyRow& max(double most) { return with(&KeySpec::max, most); }
  KeyRow& range(double least, double most) { return min(least).max(most); }
  KeyRow& above(double less) { return with(&KeySpec::above, less); }
  KeyRow& because(std::string_view why) { return with(&KeySpec::because, why); }
  KeyRow& count(std::size_t numbers) { return with(&KeySpec::count, numbers); }
  KeyRow& choices(std::vector<std::string> words) { return with(&KeySpec::choices, words); }
  KeyRow& also(std::string_view name) { return with(&KeySpec::also, name); }

 private:
  template <class Member, class Given>
  KeyRow& with(Member KeySpec::*member, const Given& given) {
    key_.*member = given;
    return *this;
  }

  KeySpec key_;
};

namespace rows {

struct Word {
  KeySpec::Type type;

  KeyRow operator()(std::string_view name, std::string_view doc = {}) const {
    return {type, name, doc};
  }
};

inline constexpr Word number{KeySpec::Type::number}, integer{KeySpec::Type::integer},
    flag{KeySpec::Type::flag}, text{KeySpec::Type::text}, choice{KeySpec::Type::choice},
    numbers{KeySpec::Type::numbers}, texts{KeySpec::Type::texts}, section{KeySpec::Type::section};

}  // namespace rows
}  // namespace config
}  // namespace armature
