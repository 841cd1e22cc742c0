// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cctype>
#include <charconv>
#include <optional>
#include <stdexcept>
#include <utility>

#include "armature/messages/type_description.hpp"

namespace armature {
namespace {

class IdlError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Words and single punctuation characters; comments, white space and preprocessor lines vanish.
class Tokens {
 public:
  explicit Tokens(std::string_view text) : text_{text} { advance(); }

  std::string_view peek() const { return token_; }
  bool at_end() const { return token_.empty(); }

  std::string_view take() {
    if (at_end()) fail("unexpected end of the file");
    const std::string_view taken = token_;
    advance();
    return taken;
  }
  bool take_if(std::string_view expected) {
    if (token_ != expected) return false;
    advance();
    return true;
  }
  void expect(std::string_view expected) {
    if (!take_if(expected)) {
      fail("expected '" + std::string{expected} + "' before '" + std::string{token_} + "'");
    }
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw IdlError{"line " + std::to_string(line_) + ": " + what};
  }

 private:
  static bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  }
  void skip_blanks() {
    while (at_ < text_.size()) {
      if (text_[at_] == '\n') {
        ++line_;
        ++at_;
      } else if (std::isspace(static_cast<unsigned char>(text_[at_]))) {
        ++at_;
      } else if (text_[at_] == '#' || text_.substr(at_, 2) == "//") {
        skip_line();
      } else {
        return;
      }
    }
  }
  void advance() {
    skip_blanks();
    std::size_t length = 0;
    while (at_ + length < text_.size() && is_word(text_[at_ + length])) ++length;
    if (length == 0 && at_ < text_.size()) length = text_.substr(at_, 2) == "::" ? 2 : 1;
    token_ = text_.substr(at_, length);
    at_ += length;
  }

  std::string_view text_;
  std::string_view token_;
  std::size_t at_ = 0;
  int line_ = 1;
};

std::string without_trailing_underscore(std::string_view name) {
  if (name.ends_with('_')) name.remove_suffix(1);
  return std::string{name};
}

class Parser {
 public:
  Parser(std::string_view text, const TypeDescriptions& known,
         std::vector<std::unique_ptr<TypeDescription>>& types)
      : tokens_{text}, known_{known}, types_{types} {}

  void file() {
    while (!tokens_.at_end()) definition("");
  }

 private:
  void definition(const std::string& scope) {
    if (tokens_.take_if("module")) {
      const std::string inner = scope + std::string{tokens_.take()} + "::";
      tokens_.expect("{");
      while (tokens_.peek() != "}") definition(inner);
    } else {
      tokens_.expect("@");
      tokens_.expect("final");
      tokens_.expect("struct");
      structure(scope);
    }
    tokens_.expect("}");
    tokens_.expect(";");
  }

  void structure(const std::string& scope) {
    const std::string name{tokens_.take()};
    auto type = std::make_unique<TypeDescription>();
    type->dds_name = scope + name;
    type->ros_name = scope.substr(0, scope.find("::")) + "/" + without_trailing_underscore(name);
    tokens_.expect("{");
    while (tokens_.peek() != "}") {
      type->fields.push_back(field(scope));
      const FieldDescription& added = type->fields.back();
      type->smallest_size += added.shape == FieldDescription::Shape::sequence ? 4
                             : added.shape == FieldDescription::Shape::array
                                 ? added.bound * smallest_size(added)
                                 : smallest_size(added);
    }
    if (type->fields.empty()) tokens_.fail("struct " + name + " has no members");
    types_.push_back(std::move(type));
  }

  FieldDescription field(const std::string& scope) {
    FieldDescription made;
    if (tokens_.take_if("sequence")) {
      made.shape = FieldDescription::Shape::sequence;
      tokens_.expect("<");
      element(scope, made);
      if (tokens_.take_if(",")) made.bound = number();
      tokens_.expect(">");
    } else {
      element(scope, made);
    }
    made.name = without_trailing_underscore(tokens_.take());
    if (tokens_.take_if("[")) {
      if (made.shape != FieldDescription::Shape::single) tokens_.fail("an array of sequences");
      made.shape = FieldDescription::Shape::array;
      made.bound = number();
      tokens_.expect("]");
    }
    tokens_.expect(";");
    return made;
  }

  void element(const std::string& scope, FieldDescription& made) {
    if (const auto kind = basic_type()) {
      made.kind = *kind;
      return;
    }
    std::string name{tokens_.take()};
    while (tokens_.take_if("::")) name += "::" + std::string{tokens_.take()};
    made.kind = FieldKind::structure;
    made.structure = find(name);
    if (!made.structure) made.structure = find(scope + name);
    if (!made.structure) tokens_.fail("unknown type '" + name + "'");
  }

  std::optional<FieldKind> basic_type() {
    if (tokens_.take_if("unsigned")) {
      if (tokens_.take_if("short")) return FieldKind::uint16;
      tokens_.expect("long");
      return tokens_.take_if("long") ? FieldKind::uint64 : FieldKind::uint32;
    }
    if (tokens_.take_if("long")) {
      return tokens_.take_if("long") ? FieldKind::int64 : FieldKind::int32;
    }
    static constexpr std::array<std::pair<std::string_view, FieldKind>, 6> kWords{
        {{"boolean", FieldKind::boolean},
         {"octet", FieldKind::octet},
         {"short", FieldKind::int16},
         {"float", FieldKind::float32},
         {"double", FieldKind::float64},
         {"string", FieldKind::text}}};
    for (const auto& [word, kind] : kWords) {
      if (tokens_.take_if(word)) return kind;
    }
    return std::nullopt;
  }

  std::uint32_t number() {
    const std::string_view word = tokens_.take();
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size() || value == 0) {
      tokens_.fail("'" + std::string{word} + "' is not a length");
    }
    return value;
  }

  const TypeDescription* find(std::string_view name) const {
    for (const auto& type : types_) {
      if (type->dds_name == name) return type.get();
    }
    return known_.find(name);
  }

  Tokens tokens_;
  const TypeDescriptions& known_;
  std::vector<std::unique_ptr<TypeDescription>>& types_;
};

}  // namespace

Expected<void> TypeDescriptions::add(std::string_view idl) {
  std::vector<std::unique_ptr<TypeDescription>> added;
  try {
    Parser{idl, *this, added}.file();
  } catch (const IdlError& error) {
    return refuse(error.what());
  }
  for (auto& type : added) types_.push_back(std::move(type));
  return {};
}

}  // namespace armature
