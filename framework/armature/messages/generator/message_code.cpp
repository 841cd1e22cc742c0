// SPDX-License-Identifier: Apache-2.0
#include "armature/messages/generator/message_code.hpp"

#include <fmt/format.h>

namespace armature {
namespace {

std::string type_of(const FieldDescription& field) {
  const std::string element =
      field.structure ? "::" + field.structure->dds_name : std::string{names_of(field.kind).cpp};
  switch (field.shape) {
    case FieldDescription::Shape::array:
      return fmt::format("std::array<{}, {}>", element, field.bound);
    case FieldDescription::Shape::sequence: return fmt::format("std::vector<{}>", element);
    case FieldDescription::Shape::single: break;
  }
  return element;
}

bool is_number(const FieldDescription& field) {
  return field.shape == FieldDescription::Shape::single && field.kind != FieldKind::text &&
         field.kind != FieldKind::structure;
}

/// "JointState_" of "sensor_msgs::msg::dds_::JointState_".
std::string last_part(const std::string& name) { return name.substr(name.rfind(':') + 1); }

/// "sensor_msgs::msg::dds_" of the same.
std::string scope_of(const std::string& name) { return name.substr(0, name.rfind("::")); }

/// "sensor_msgs::msg": where ROS 2 has the type.
std::string ros_scope_of(const std::string& name) { return scope_of(scope_of(name)); }

/// Texts and sequences are copied into what is there, which reuses its memory, or moved.
std::string accessors(const FieldDescription& field) {
  const std::string name = field.name + "_", type = type_of(field);
  std::string text;
  if (is_number(field)) {
    text = fmt::format(
        "  {1} {0}() const {{ return {0}value; }}\n"
        "  void {0}({1} value) {{ {0}value = value; }}\n",
        name, type);
  } else {
    text = fmt::format(
        "  const {1}& {0}() const {{ return {0}value; }}\n"
        "  void {0}(const {1}& value) {{ {0}value = value; }}\n"
        "  void {0}({1}&& value) {{ {0}value = std::move(value); }}\n",
        name, type);
  }
  return text + fmt::format("  {1}& {0}() {{ return {0}value; }}\n", name, type);
}

std::string class_of(const TypeDescription& type) {
  std::string access, members, out, in;
  for (const FieldDescription& field : type.fields) {
    access += accessors(field);
    members += fmt::format("  {} {}_value{{}};\n", type_of(field), field.name);
    out += fmt::format(" << {}_value", field.name);
    in += fmt::format(" >> {}_value", field.name);
  }
  return fmt::format(R"(
/// {0}
class [[gnu::visibility("default")]] {1} {{
 public:
  static constexpr std::uint64_t kLayout = {2:#018x};

{3}
  {1}();
  {1}(const {1}&);
  {1}({1}&&) noexcept;
  {1}& operator=(const {1}&);
  {1}& operator=({1}&&) noexcept;
  ~{1}();
  bool operator==(const {1}&) const;
  template <class Cdr>
  void serialize(Cdr& cdr) const {{
    cdr{4};
  }}
  template <class Cdr>
  void deserialize(Cdr& cdr) {{
    cdr{5};
  }}

 private:
{6}}};
)",
                     type.ros_name, last_part(type.dds_name), layout_hash(type), access, out, in,
                     members);
}

/// Compiled once, and not in every file that has such a message.
std::string special_members_of(const TypeDescription& type) {
  return fmt::format(R"(
{0}::{1}() = default;
{0}::{1}(const {1}&) = default;
{0}::{1}({1}&&) noexcept = default;
{0}& {0}::operator=(const {1}&) = default;
{0}& {0}::operator=({1}&&) noexcept = default;
{0}::~{1}() = default;
bool {0}::operator==(const {1}&) const = default;
)",
                     type.dds_name, last_part(type.dds_name));
}

std::string constant_of(const ConstantDescription& constant) {
  const bool is_text = constant.kind == FieldKind::text;
  std::string value = constant.value;
  if (constant.kind == FieldKind::boolean) value = value == "TRUE" ? "true" : "false";
  return fmt::format("inline constexpr {} {}{{{}}};\n",
                     is_text ? "std::string_view" : names_of(constant.kind).cpp,
                     last_part(constant.name), value);
}

/// Definitions in the order of the file, with as few changes of the namespace as there are.
class Namespaces {
 public:
  void add(const std::string& name, const std::string& definition) {
    if (name != open_) close();
    if (open_.empty()) text_ += fmt::format("\nnamespace {} {{\n", name);
    open_ = name;
    text_ += definition;
  }
  std::string text() {
    close();
    return text_;
  }

 private:
  void close() {
    if (!open_.empty()) text_ += fmt::format("\n}}  // namespace {}\n", open_);
    open_.clear();
  }
  std::string open_, text_;
};

}  // namespace

std::string message_header(const IdlFile& file, const std::string& alias) {
  std::string text = fmt::format(
      "// Made by armature-messages from {}: change it there.\n#pragma once\n\n"
      "#include <array>\n#include <cstdint>\n#include <string>\n#include <string_view>\n"
      "#include <utility>\n#include <vector>\n\n",
      file.path.filename().string());
  for (const std::string& header : file.includes) text += fmt::format("#include \"{}\"\n", header);
  text += "#include \"armature/messages/message_type.hpp\"\n";
  const auto scope = [&](const std::string& name) {
    return alias.empty() ? ros_scope_of(name) : alias;
  };
  Namespaces definitions, aliases;
  for (const ConstantDescription& constant : file.constants) {
    definitions.add(scope_of(constant.name), constant_of(constant));
    aliases.add(scope(constant.name), fmt::format("using ::{};\n", constant.name));
  }
  for (const TypeDescription* type : file.types) {
    const std::string name = last_part(type->dds_name);
    definitions.add(scope_of(type->dds_name), class_of(*type));
    aliases.add(scope(type->dds_name),
                fmt::format("using {} = ::{};\n", name.substr(0, name.size() - 1), type->dds_name));
  }
  return text + definitions.text() + aliases.text();
}

std::string message_source(std::span<const IdlFile> files) {
  std::string names, includes, members, idl, definitions, all;
  for (const IdlFile& file : files) {
    names += " " + file.path.filename().string();
    includes += fmt::format("#include \"{}\"\n", file.header);
    idl += file.text;
    for (const TypeDescription* type : file.types) {
      members += special_members_of(*type);
      const std::string symbol =
          fmt::format("defined_message<::{0}, ::{0}::kLayout>", type->dds_name);
      definitions += fmt::format(R"(
template <>
const MessageType& {1}() {{
  static const MessageType type = library.define<::{0}>("{0}");
  return type;
}}
)",
                                 type->dds_name, symbol);
      all += fmt::format("    &{},\n", symbol);
    }
  }
  return fmt::format(R"(// Made by armature-messages from{0}.
#include "armature/messages/message_library.hpp"
{1}{2}
namespace armature {{
namespace {{

// A section of its own is read without loading the library, by `armature topic echo` for one.
const char idl[] __attribute__((section(".armature.idl"), used, retain)) =
    R"armature({3})armature";

const MessageLibrary library{{idl}};

}}  // namespace
{4}
namespace {{
[[maybe_unused]] const bool known = library.make_known({{
{5}}});
}}  // namespace

}}  // namespace armature
)",
                     names, includes, members, idl, definitions, all);
}

}  // namespace armature
