// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/ik/lines/reason.hpp"

namespace armature::ik_lines {

std::string reason_of(const IkStatus& status) {
  const std::string text = describe(status);
  const std::string name = std::string{to_string(status.code)} + ": ";
  return text.starts_with(name) ? text.substr(name.size()) : text;
}

std::string detail_in(std::string_view reason, IkStatus::Code code, double shortfall) {
  constexpr std::string_view kMark = "\x01";
  if (reason == reason_of({code, shortfall, {}})) return "";
  const std::string frame = reason_of({code, shortfall, kMark});
  const std::string_view before = std::string_view{frame}.substr(0, frame.find(kMark));
  const std::string_view after = std::string_view{frame}.substr(before.size() + 1);
  const bool framed = reason.size() > before.size() + after.size() && reason.starts_with(before) &&
                      reason.ends_with(after);
  if (!framed) return std::string{reason};
  return std::string{reason.substr(before.size(), reason.size() - before.size() - after.size())};
}

}  // namespace armature::ik_lines
