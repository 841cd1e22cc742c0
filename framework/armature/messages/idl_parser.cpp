// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <utility>

#include "armature/messages/idl_tokens.hpp"
#include "armature/messages/type_description.hpp"

namespace armature {
namespace {

/// What IDL knows and messages do without. `char` is one octet there, and no letter in ROS 2.
constexpr std::array<std::string_view, 16> kUnsupported{
    "any", "bitmask", "bitset", "char",    "enum",  "exception", "fixed", "interface",
    "map", "native",  "struct", "typedef", "union", "valuetype", "wchar", "wstring"};

/// [byte] An array of such structs still has a size that can be counted with.
constexpr std::size_t kMaxStruct = 1U << 30U;

bool is_unsupported(std::string_view word) {
  return std::ranges::find(kUnsupported, word) != kUnsupported.end();
}

template <class Number>
std::optional<Number> number_of(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Whether `text` is a number that a constant of this kind may have.
bool is_value(FieldKind kind, std::string_view text) {
  switch (kind) {
    case FieldKind::boolean: return text == "TRUE" || text == "FALSE";
    case FieldKind::octet: return number_of<std::uint8_t>(text).has_value();
    case FieldKind::int8: return number_of<std::int8_t>(text).has_value();
    case FieldKind::int16: return number_of<std::int16_t>(text).has_value();
    case FieldKind::uint16: return number_of<std::uint16_t>(text).has_value();
    case FieldKind::int32: return number_of<std::int32_t>(text).has_value();
    case FieldKind::uint32: return number_of<std::uint32_t>(text).has_value();
    case FieldKind::int64: return number_of<std::int64_t>(text).has_value();
    case FieldKind::uint64: return number_of<std::uint64_t>(text).has_value();
    case FieldKind::float32: return number_of<float>(text).has_value();
    case FieldKind::float64: return number_of<double>(text).has_value();
    case FieldKind::text:
      return text.size() >= 2 && text.front() == '"' && text.find('\\') == std::string_view::npos;
    case FieldKind::structure: return false;
  }
  return false;
}

class Parser {
 public:
  Parser(IdlTokens tokens, const TypeDescriptions& known,
         std::vector<std::unique_ptr<TypeDescription>>& types,
         std::vector<ConstantDescription>& constants)
      : tokens_{tokens}, known_{known}, types_{types}, constants_{constants} {}

  void file() {
    while (!tokens_.at_end()) definition("");
  }

 private:
  void definition(const std::string& scope) {
    if (tokens_.take_if("module")) {
      const std::string inner = scope + std::string{tokens_.identifier()} + "::";
      tokens_.expect("{");
      while (tokens_.peek() != "}") definition(inner);
      tokens_.expect("}");
    } else if (tokens_.take_if("const")) {
      constant(scope);
    } else {
      if (tokens_.peek() == "struct") tokens_.fail("a struct must be '@final struct'");
      if (is_unsupported(tokens_.peek())) refuse_word();
      tokens_.expect("@");
      if (tokens_.peek() != "final") refuse_annotation();
      tokens_.take();
      tokens_.expect("struct");
      structure(scope);
      tokens_.expect("}");
    }
    tokens_.expect(";");
  }

  void constant(const std::string& scope) {
    const auto kind = basic_type();
    if (!kind) tokens_.fail("a constant of type '" + std::string{tokens_.peek()} + "'");
    std::string name = scope + std::string{tokens_.identifier()};
    if (std::ranges::find(constants_, name, &ConstantDescription::name) != constants_.end()) {
      tokens_.fail_taken("a second constant '" + name + "'");
    }
    tokens_.expect("=");
    std::string value;  // "-1.5e-3" is several tokens
    while (tokens_.peek() != ";") value += tokens_.take();
    if (!is_value(*kind, value)) tokens_.fail_taken("'" + value + "' is not a value of its type");
    constants_.push_back({.name = std::move(name), .kind = *kind, .value = std::move(value)});
  }

  /// ROS 2 ends the names of structs and members on DDS in '_'; it is cut off.
  std::string stem() {
    const std::string name{tokens_.identifier()};
    if (!name.ends_with('_') || name.size() == 1) {
      tokens_.fail_taken("'" + name + "' must end in '_', as names of ROS 2 do on DDS");
    }
    return name.substr(0, name.size() - 1);
  }

  void structure(const std::string& scope) {
    const std::string name = stem();
    auto type = std::make_unique<TypeDescription>();
    type->dds_name = scope + name + "_";
    type->ros_name = scope.substr(0, scope.find("::")) + "/" + name;
    if (tokens_.peek() == ":") tokens_.fail(name + "_ has a base, which is not supported");
    tokens_.expect("{");
    while (tokens_.peek() != "}") {
      FieldDescription added = field(scope);
      if (std::ranges::find(type->fields, added.name, &FieldDescription::name) !=
          type->fields.end()) {
        tokens_.fail_taken("a second member '" + added.name + "_'");
      }
      type->smallest_size += added.shape == FieldDescription::Shape::sequence ? 4
                             : added.shape == FieldDescription::Shape::array
                                 ? added.bound * smallest_size(added)
                                 : smallest_size(added);
      type->fields.push_back(std::move(added));
    }
    if (type->fields.empty()) tokens_.fail_taken("struct " + name + "_ has no members");
    if (type->smallest_size > kMaxStruct) tokens_.fail_taken("struct " + name + "_ is too large");
    if (find_here(type->dds_name)) tokens_.fail_taken("a second struct " + name + "_");
    const TypeDescription* other = known_.find(type->dds_name);
    if (other && layout_hash(*other) != layout_hash(*type)) {
      tokens_.fail_taken(type->ros_name + " is known with other members");
    }
    types_.push_back(std::move(type));
  }

  FieldDescription field(const std::string& scope) {
    FieldDescription made;
    if (tokens_.take_if("@")) refuse_annotation();
    if (tokens_.take_if("sequence")) {
      made.shape = FieldDescription::Shape::sequence;
      tokens_.expect("<");
      if (tokens_.peek() == "sequence") tokens_.fail("a sequence of sequences");
      element(scope, made);
      if (tokens_.take_if(",")) made.bound = length(scope);
      tokens_.expect(">");
    } else {
      element(scope, made);
    }
    made.name = stem();
    if (tokens_.take_if("[")) {
      if (made.shape != FieldDescription::Shape::single) tokens_.fail("an array of sequences");
      made.shape = FieldDescription::Shape::array;
      made.bound = length(scope);
      tokens_.expect("]");
      if (tokens_.peek() == "[") tokens_.fail("an array of arrays");
    }
    tokens_.expect(";");
    return made;
  }

  void element(const std::string& scope, FieldDescription& made) {
    if (const auto kind = basic_type()) {
      if (tokens_.peek() == "<") tokens_.fail("a string with a bound");
      made.kind = *kind;
      return;
    }
    if (is_unsupported(tokens_.peek())) refuse_word();
    std::string name{tokens_.identifier()};
    while (tokens_.take_if("::")) name += "::" + std::string{tokens_.identifier()};
    made.kind = FieldKind::structure;
    made.structure = find(name);
    if (!made.structure) made.structure = find(scope + name);
    if (!made.structure) tokens_.fail_taken("unknown type '" + name + "'");
  }

  std::optional<FieldKind> basic_type() {
    if (tokens_.take_if("unsigned")) {
      if (tokens_.take_if("short")) return FieldKind::uint16;
      tokens_.expect("long");
      return tokens_.take_if("long") ? FieldKind::uint64 : FieldKind::uint32;
    }
    if (tokens_.take_if("long")) {
      if (tokens_.peek() == "double") tokens_.fail("'long double' is not supported");
      return tokens_.take_if("long") ? FieldKind::int64 : FieldKind::int32;
    }
    static constexpr std::array<std::pair<std::string_view, FieldKind>, 14> kWords{
        {{"boolean", FieldKind::boolean},
         {"octet", FieldKind::octet},
         {"short", FieldKind::int16},
         {"float", FieldKind::float32},
         {"double", FieldKind::float64},
         {"string", FieldKind::text},
         {"int8", FieldKind::int8},
         {"uint8", FieldKind::octet},
         {"int16", FieldKind::int16},
         {"uint16", FieldKind::uint16},
         {"int32", FieldKind::int32},
         {"uint32", FieldKind::uint32},
         {"int64", FieldKind::int64},
         {"uint64", FieldKind::uint64}}};
    for (const auto& [word, kind] : kWords) {
      if (tokens_.take_if(word)) return kind;
    }
    return std::nullopt;
  }

  /// A number, or a constant of this file.
  std::uint32_t length(const std::string& scope) {
    std::string text{tokens_.take()};
    const auto constant = std::ranges::find(constants_, scope + text, &ConstantDescription::name);
    if (constant != constants_.end()) text = constant->value;
    const auto value = number_of<std::uint32_t>(text);
    if (!value || *value == 0) tokens_.fail_taken("'" + text + "' is not a length");
    return *value;
  }

  const TypeDescription* find_here(std::string_view name) const {
    const auto found = std::ranges::find(
        types_, name, [](const auto& type) -> const std::string& { return type->dds_name; });
    return found == types_.end() ? nullptr : found->get();
  }
  const TypeDescription* find(std::string_view name) const {
    const TypeDescription* here = find_here(name);
    return here ? here : known_.find(name);
  }

  [[noreturn]] void refuse_word() const {
    tokens_.fail("'" + std::string{tokens_.peek()} + "' is not supported");
  }
  [[noreturn]] void refuse_annotation() const {
    tokens_.fail("'@" + std::string{tokens_.peek()} + "' is not supported");
  }

  IdlTokens tokens_;
  const TypeDescriptions& known_;
  std::vector<std::unique_ptr<TypeDescription>>& types_;
  std::vector<ConstantDescription>& constants_;
};

}  // namespace

Expected<void> TypeDescriptions::add(std::string_view idl, std::string_view file) {
  std::vector<std::unique_ptr<TypeDescription>> types;
  std::vector<ConstantDescription> constants;
  try {
    Parser{IdlTokens{idl, file}, *this, types, constants}.file();
  } catch (const IdlError& error) {
    return refuse(error.what());
  }
  for (auto& type : types) types_.push_back(std::move(type));
  for (auto& constant : constants) constants_.push_back(std::move(constant));
  return {};
}

}  // namespace armature
