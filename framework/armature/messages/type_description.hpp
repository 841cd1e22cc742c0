// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

struct TypeDescription;

enum class FieldKind {
  boolean,
  octet,
  int8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64,
  text,
  structure
};

/// What a kind of field is called; the names of `structure` are its type's own.
struct KindNames {
  FieldKind kind;
  std::string_view idl, ros, cpp;
  std::size_t smallest_size;  // [byte] of its CDR
};

const KindNames& names_of(FieldKind kind);

/// A field of a message type as its IDL states it.
struct FieldDescription {
  enum class Shape { single, array, sequence };

  std::string name;  // without IDL's trailing underscore: "frame_id"
  FieldKind kind = FieldKind::octet;
  Shape shape = Shape::single;
  std::uint32_t bound = 0;                     // length of an array, bound of a sequence (0: none)
  const TypeDescription* structure = nullptr;  // kind structure
};

/// A message type as its IDL states it: enough to read its CDR without generated code.
struct TypeDescription {
  std::string dds_name;  // "sensor_msgs::msg::dds_::JointState_"
  std::string ros_name;  // "sensor_msgs/JointState"
  std::vector<FieldDescription> fields;
  std::size_t smallest_size = 0;  // [byte] of an encoding without padding and with empty sequences
};

/// `const octet RAINING = 2;`
struct ConstantDescription {
  std::string name;  // with its modules: "weather_msgs::msg::dds_::RAINING"
  FieldKind kind = FieldKind::octet;
  std::string value;  // as IDL writes it: "2", "TRUE", "\"text\""
};

/// Bytes of one element without padding; a string's or sequence's length counts 4.
std::size_t smallest_size(const FieldDescription& field);

/// Types by name, as read from IDL. The addresses of its descriptions do not change.
class TypeDescriptions {
 public:
  /// Reads the subset of IDL that messages need: modules, final structs, numbers, string, arrays,
  /// sequences, constants. What else IDL knows is refused by name. Preprocessor lines are passed
  /// over: add the included files first. A struct that is known already is taken when it is the
  /// same. The reason names file and line.
  Expected<void> add(std::string_view idl, std::string_view file);
  /// By ROS or DDS name; nullptr: unknown.
  const TypeDescription* find(std::string_view name) const;
  const std::vector<std::unique_ptr<TypeDescription>>& all() const { return types_; }
  const std::vector<ConstantDescription>& constants() const { return constants_; }

 private:
  std::vector<std::unique_ptr<TypeDescription>> types_;
  std::vector<ConstantDescription> constants_;
};

/// FNV-1a of the type's name and its flattened field list: equal only for the same layout.
std::uint64_t layout_hash(const TypeDescription& type);

}  // namespace armature
