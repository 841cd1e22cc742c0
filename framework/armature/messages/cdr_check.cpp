// SPDX-License-Identifier: Apache-2.0
#include "armature/messages/cdr_check.hpp"

#include <string>

#include "armature/messages/cdr_reader.hpp"

namespace armature {
namespace {

/// Passes over a type's encoding; on failure `place` holds the path to the field.
class Walk {
 public:
  explicit Walk(std::span<const std::byte> cdr) : reader_{cdr} {}

  bool structure(const TypeDescription& type) {
    for (const FieldDescription& field : type.fields) {
      if (!this->field(field)) {
        place_ = field.name + (place_.empty() ? "" : "." + place_);
        return false;
      }
    }
    return true;
  }
  const CdrReader& reader() const { return reader_; }
  const std::string& place() const { return place_; }

 private:
  bool field(const FieldDescription& field) {
    std::size_t count = 1;
    if (field.shape == FieldDescription::Shape::array) count = field.bound;
    if (field.shape == FieldDescription::Shape::sequence) {
      count = reader_.number<std::uint32_t>();
      if (field.bound != 0 && count > field.bound) return false;
    }
    const std::size_t size = smallest_size(field);
    if (count > reader_.remaining() / size) return reader_.ok() && count == 0;
    if (field.kind == FieldKind::structure) {
      for (std::size_t i = 0; i < count; ++i) {
        if (!structure(*field.structure)) return false;
      }
    } else if (field.kind == FieldKind::text) {
      for (std::size_t i = 0; i < count; ++i) reader_.text();
    } else {
      reader_.take(size, count);
    }
    return reader_.ok();
  }

  CdrReader reader_;
  std::string place_;
};

}  // namespace

Expected<void> check_cdr(const TypeDescription& type, std::span<const std::byte> cdr) {
  Walk walk{cdr};
  if (!walk.reader().ok()) {
    return refuse(type.ros_name + ": " + std::to_string(cdr.size()) +
                  " bytes that do not begin with a plain CDR header (00 00 or 00 01)");
  }
  if (!walk.structure(type)) {
    return refuse(type.ros_name + "." + walk.place() + ": does not fit into the " +
                  std::to_string(cdr.size()) + " bytes, from byte " +
                  std::to_string(walk.reader().position()) + " on");
  }
  constexpr std::size_t kGreatestPadding = 3;  // payloads are padded to 4 bytes by some senders
  if (walk.reader().remaining() > kGreatestPadding) {
    return refuse(type.ros_name + ": " + std::to_string(walk.reader().remaining()) +
                  " bytes are left over after the last field");
  }
  return {};
}

}  // namespace armature
