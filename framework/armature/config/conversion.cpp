// SPDX-License-Identifier: Apache-2.0
#include "armature/config/conversion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <limits>
#include <string_view>

#include "armature/config/problems.hpp"

namespace armature::config {
namespace {

tl::unexpected<Mismatch> mismatch(const Node& node, std::string message) {
  return tl::unexpected<Mismatch>{Mismatch{node.origin(), std::move(message)}};
}

std::size_t count_digits(std::string_view text) {
  const auto end = std::ranges::find_if(text, [](char c) { return c < '0' || c > '9'; });
  return static_cast<std::size_t>(end - text.begin());
}

std::string_view without_sign(std::string_view text) {
  if (text.starts_with('+') || text.starts_with('-')) text.remove_prefix(1);
  return text;
}

/// The length of the decimal number, without sign, that `text` starts with; 0: none.
std::size_t decimal_length(std::string_view text) {
  const std::size_t whole = count_digits(text);
  std::size_t at = whole;
  std::size_t fraction = 0;
  if (text.substr(at).starts_with('.')) {
    fraction = count_digits(text.substr(at + 1));
    at += 1 + fraction;
  }
  if (whole + fraction == 0) return 0;
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    const std::string_view exponent = text.substr(at + 1);
    const std::size_t sign = exponent.size() - without_sign(exponent).size();
    const std::size_t digits = count_digits(exponent.substr(sign));
    if (digits > 0) at += 1 + sign + digits;
  }
  return at;
}

bool is_decimal(std::string_view text) {
  const std::string_view magnitude = without_sign(text);
  return !magnitude.empty() && decimal_length(magnitude) == magnitude.size();
}

bool has_leading_zero(std::string_view text) {
  const std::string_view magnitude = without_sign(text);
  return magnitude.size() > 1 && magnitude[0] == '0' && magnitude[1] >= '0' && magnitude[1] <= '9';
}

std::string without(std::string_view text, char removed) {
  std::string result{text};
  std::erase(result, removed);
  return result;
}

std::string without_leading_zeros(std::string_view text) {
  const std::string_view magnitude = without_sign(text);
  const std::size_t sign = text.size() - magnitude.size();
  std::size_t zeros = 0;
  while (has_leading_zero(magnitude.substr(zeros))) ++zeros;
  return std::string{text.substr(0, sign)} + std::string{magnitude.substr(zeros)};
}

std::optional<std::uint64_t> other_base(std::string_view text) {
  if (text.size() < 3 || text[0] != '0') return std::nullopt;
  const int base = text[1] == 'x' ? 16 : text[1] == 'o' ? 8 : text[1] == 'b' ? 2 : 0;
  if (base == 0) return std::nullopt;
  std::uint64_t value = 0;
  const auto [end, error] =
      std::from_chars(text.data() + 2, text.data() + text.size(), value, base);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

bool is_not_finite(std::string_view text) {
  std::string word{without_sign(text)};
  std::ranges::transform(word, word.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::array<std::string_view, 5> kWords{".inf", ".nan", "inf", "nan", "infinity"};
  return std::ranges::find(kWords, word) != kWords.end();
}

/// The way out for a scalar that a reader of another YAML dialect would take for a number.
std::string number_hint(const Node& node) {
  const std::string& text = node.text();
  if (node.quoted()) return is_decimal(text) ? "; write it without quotes" : "";
  if (is_not_finite(text)) return "; it must be finite";
  if (const auto value = other_base(without_sign(text))) {
    return fmt::format("; write {}{}", text.starts_with('-') ? "-" : "", *value);
  }
  if (is_decimal(without(text, '_'))) return "; write " + without(text, '_');
  const std::size_t comma = text.find(',');
  if (comma != std::string::npos) {
    std::string point = text;
    point[comma] = '.';
    if (is_decimal(point)) return "; write " + point;
  }
  const std::string_view magnitude = without_sign(text);
  const std::size_t length = decimal_length(magnitude);
  if (length > 0) {
    return fmt::format("; write {} alone: the unit is part of the key's name",
                       text.substr(0, text.size() - magnitude.size() + length));
  }
  return "";
}

/// The digits to convert; a mismatch that says `wanted` when the node is no decimal number.
Converted<std::string_view> decimal_text(const Node& node, std::string_view wanted) {
  if (node.kind() != Node::Kind::scalar) {
    return mismatch(node, fmt::format("must be {}, not {}", wanted, node.describe()));
  }
  const std::string& text = node.text();
  if (node.quoted() || !is_decimal(text)) {
    return mismatch(node, fmt::format("must be {}, not {}{}{}", wanted,
                                      node.quoted() && is_decimal(text) ? "the text " : "",
                                      node.describe(), number_hint(node)));
  }
  if (has_leading_zero(text)) {
    return mismatch(node, fmt::format("must be {0}, and '{1}' is octal to some readers; write {2}",
                                      wanted, text, without_leading_zeros(text)));
  }
  std::string_view digits = text;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  return digits;
}

}  // namespace

Converted<double> to_number(const Node& node) {
  const auto digits = decimal_text(node, "a number");
  if (!digits) return tl::unexpected{digits.error()};
  double value = 0;
  const auto [end, error] = std::from_chars(digits->data(), digits->data() + digits->size(), value);
  if (error != std::errc{}) {
    return mismatch(node, fmt::format("is {}, which a double cannot hold", node.describe()));
  }
  return value;
}

Converted<std::int64_t> to_integer(const Node& node) {
  const auto digits = decimal_text(node, "a whole number");
  if (!digits) return tl::unexpected{digits.error()};
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits->data(), digits->data() + digits->size(), value);
  if (end != digits->data() + digits->size()) {
    return mismatch(node, fmt::format("must be a whole number, not {}", node.describe()));
  }
  if (error != std::errc{}) {
    return mismatch(node, fmt::format("is {}, which 64 bits cannot hold", node.describe()));
  }
  return value;
}

Converted<std::uint64_t> to_natural(const Node& node) {
  const std::string wanted =
      fmt::format("a whole number from 0 to {}", std::numeric_limits<std::uint64_t>::max());
  const auto digits = decimal_text(node, wanted);
  if (!digits) return tl::unexpected{digits.error()};
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(digits->data(), digits->data() + digits->size(), value);
  if (error != std::errc{} || end != digits->data() + digits->size()) {
    return mismatch(node, fmt::format("must be {}, not {}", wanted, node.describe()));
  }
  return value;
}

Converted<bool> to_flag(const Node& node) {
  if (node.kind() == Node::Kind::scalar && !node.quoted()) {
    if (node.text() == "true") return true;
    if (node.text() == "false") return false;
  }
  return mismatch(node, "must be true or false, not " + node.describe());
}

Converted<std::string> to_text(const Node& node) {
  if (node.kind() == Node::Kind::scalar) return node.text();
  return mismatch(node, "must be a text, not " + node.describe());
}

Converted<std::vector<double>> to_numbers(const Node& node, std::optional<std::size_t> count) {
  const std::string wanted =
      count ? fmt::format("must be a list of {} numbers", *count) : "must be a list of numbers";
  if (node.kind() != Node::Kind::sequence) {
    return mismatch(node, fmt::format("{}, not {}", wanted, node.describe()));
  }
  if (count && node.items().size() != *count) {
    return mismatch(node, fmt::format("{}, not of {}", wanted, node.items().size()));
  }
  std::vector<double> values;
  for (const Node& item : node.items()) {
    const auto value = to_number(item);
    if (!value) {
      return mismatch(
          item, fmt::format("{}; item {} {}", wanted, values.size() + 1, value.error().message));
    }
    values.push_back(*value);
  }
  return values;
}

Converted<std::vector<std::string>> to_texts(const Node& node) {
  if (node.kind() != Node::Kind::sequence) {
    return mismatch(node, "must be a list of texts, not " + node.describe());
  }
  std::vector<std::string> texts;
  for (const Node& item : node.items()) {
    const auto text = to_text(item);
    if (!text) {
      return mismatch(item, fmt::format("must be a list of texts; item {} {}", texts.size() + 1,
                                        text.error().message));
    }
    texts.push_back(*text);
  }
  return texts;
}

}  // namespace armature::config
