// SPDX-License-Identifier: Apache-2.0
#include "armature/messages/cdr_to_json.hpp"

#include <nlohmann/json.hpp>

#include "armature/messages/cdr_check.hpp"
#include "armature/messages/cdr_reader.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t kShownOctets = 64;

/// Of bytes that passed check_cdr.
class Converter {
 public:
  Converter(std::span<const std::byte> cdr, OctetArrays octets) : reader_{cdr}, octets_{octets} {}

  Json structure(const TypeDescription& type) {
    Json object = Json::object();
    for (const FieldDescription& field : type.fields) object[field.name] = value(field);
    return object;
  }

 private:
  Json value(const FieldDescription& field) {
    if (field.shape == FieldDescription::Shape::single) return element(field);
    const std::size_t count = field.shape == FieldDescription::Shape::array
                                  ? field.bound
                                  : reader_.number<std::uint32_t>();
    if (field.kind == FieldKind::octet && count > kShownOctets &&
        octets_ == OctetArrays::shortened) {
      return shortened(reader_.take(1, count));
    }
    Json array = Json::array();
    for (std::size_t i = 0; i < count; ++i) array.push_back(element(field));
    return array;
  }

  static Json shortened(std::span<const std::byte> bytes) {
    Json first = Json::array();
    for (const std::byte b : bytes.first(kShownOctets)) first.push_back(std::to_integer<int>(b));
    return Json{{"octets", bytes.size()}, {"first", std::move(first)}};
  }

  Json element(const FieldDescription& field) {
    switch (field.kind) {
      case FieldKind::boolean: return reader_.number<std::uint8_t>() != 0;
      case FieldKind::octet: return reader_.number<std::uint8_t>();
      case FieldKind::int8: return reader_.number<std::int8_t>();
      case FieldKind::int16: return reader_.number<std::int16_t>();
      case FieldKind::uint16: return reader_.number<std::uint16_t>();
      case FieldKind::int32: return reader_.number<std::int32_t>();
      case FieldKind::uint32: return reader_.number<std::uint32_t>();
      case FieldKind::int64: return reader_.number<std::int64_t>();
      case FieldKind::uint64: return reader_.number<std::uint64_t>();
      case FieldKind::float32: return reader_.number<float>();
      case FieldKind::float64: return reader_.number<double>();
      case FieldKind::text: return std::string{reader_.text()};
      case FieldKind::structure: return structure(*field.structure);
    }
    return nullptr;
  }

  CdrReader reader_;
  OctetArrays octets_;
};

}  // namespace

Expected<Json> cdr_to_json(const TypeDescription& type, std::span<const std::byte> cdr,
                           OctetArrays octets) {
  if (const auto checked = check_cdr(type, cdr); !checked) {
    return tl::unexpected{checked.error()};
  }
  return Converter{cdr, octets}.structure(type);
}

}  // namespace armature
