// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/fast_dds/endpoint_tag.hpp"

#include <charconv>
#include <string_view>

namespace armature {
namespace {

constexpr std::string_view kFirstWord = "armature";

std::string hex(std::uint64_t value) {
  std::string digits(16, '0');
  for (auto digit = digits.rbegin(); digit != digits.rend(); ++digit, value >>= 4) {
    *digit = "0123456789abcdef"[value & 0xf];
  }
  return digits;
}

}  // namespace

std::string to_user_data(const EndpointTag& tag) {
  return std::string{kFirstWord} + ";deployment=" + tag.deployment +
         ";fingerprint=" + tag.fingerprint + ";run=" + tag.run + ";layout=" + hex(tag.layout);
}

EndpointTag parse_endpoint_tag(std::span<const std::uint8_t> user_data) {
  std::string_view rest{reinterpret_cast<const char*>(user_data.data()), user_data.size()};
  const auto take_field = [&rest] {
    const std::size_t end = rest.find(';');
    const std::string_view field = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    return field;
  };
  EndpointTag tag;
  if (take_field() != kFirstWord) return tag;
  tag.ours = true;
  while (!rest.empty()) {
    const std::string_view field = take_field();
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos) continue;
    const std::string_view value = field.substr(equals + 1);
    if (field.starts_with("deployment=")) tag.deployment = value;
    if (field.starts_with("fingerprint=")) tag.fingerprint = value;
    if (field.starts_with("run=")) tag.run = value;
    if (field.starts_with("layout=")) {
      std::from_chars(value.data(), value.data() + value.size(), tag.layout, 16);
    }
  }
  return tag;
}

}  // namespace armature
