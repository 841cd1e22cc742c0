// SPDX-License-Identifier: Apache-2.0
#include "replay/field_differences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "armature/messages/cdr_to_json.hpp"
#include "armature/messages/known_types.hpp"
#include "armature/values/json_text.hpp"

namespace armature {
namespace {

/// Takes NaN for equal to NaN, which JSON does not.
bool is_none_in_both(const nlohmann::ordered_json& before, const nlohmann::ordered_json& now) {
  return before.is_number_float() && now.is_number_float() && std::isnan(before.get<double>()) &&
         std::isnan(now.get<double>());
}

}  // namespace

void TopicDifferences::compare(const MessageType& type, std::span<const std::byte> before,
                               std::span<const std::byte> now, double at_s) {
  const bool differs = !std::ranges::equal(before, now);
  ++messages_;
  differing_ += differs ? 1 : 0;
  const TypeDescription* description = describe_type(type.dds_name);
  if (!description) return;
  const auto first = cdr_to_json(*description, before), second = cdr_to_json(*description, now);
  if (!first || !second) return;
  follow_joints(*first, 0);
  follow_joints(*second, 1);
  if (!differs) return;
  in_message_.clear();
  walk(*first, *second, {}, at_s);
  // A picture has a million octets, of which mostly one of the first differs already.
  if (in_message_.empty()) {
    const auto whole = [&](std::span<const std::byte> cdr) {
      return cdr_to_json(*description, cdr, OctetArrays::whole).value();
    };
    walk(whole(before), whole(now), {}, at_s);
  }
  for (const auto& [name, is_in] : in_message_) ++fields_[name].messages;
}

void TopicDifferences::add_only_before(const MessageType& type, std::span<const std::byte> cdr) {
  ++only_before_;
  follow_joints(type, cdr, 0);
}

void TopicDifferences::add_only_now(const MessageType& type, std::span<const std::byte> cdr) {
  ++only_now_;
  follow_joints(type, cdr, 1);
}

void TopicDifferences::walk(const Json& before, const Json& now, const Place& place, double at_s) {
  if (before.is_object() && now.is_object()) {
    const std::string dot = place.name.empty() ? "" : ".";
    static const Json kNone;
    const bool is_shortened = before.contains("octets") && before.contains("first");
    for (const auto& [key, value] : before.items()) {
      const auto other = now.find(key);
      const std::string name = is_shortened && key == "first" ? "" : dot + key;
      walk(value, other == now.end() ? kNone : *other, {place.name + name, place.element + name},
           at_s);
    }
  } else if (before.is_array() && now.is_array()) {
    walk_array(before, now, place, at_s);
  } else if (!(before == now) && !is_none_in_both(before, now)) {
    add(place, before, now, at_s);
  }
}

void TopicDifferences::walk_array(const Json& before, const Json& now, const Place& place,
                                  double at_s) {
  for (std::size_t i = 0; i < std::min(before.size(), now.size()); ++i) {
    if (before[i] == now[i]) continue;
    walk(before[i], now[i], {place.name + "[]", fmt::format("{}[{}]", place.element, i)}, at_s);
    // Only the first integer that differs is told: a picture has a million octets.
    if (before[i].is_number_integer()) break;
  }
  if (before.size() != now.size()) {
    add({"elements of " + place.name, place.element}, Json(std::to_string(before.size())),
        Json(std::to_string(now.size())), at_s);
  }
}

void TopicDifferences::add(const Place& place, const Json& before, const Json& now, double at_s) {
  if (!before.is_number_float() || !now.is_number_float()) {
    return add_text(place, json_text(before), json_text(now), at_s);
  }
  const double first = before.get<double>(), second = now.get<double>();
  if (!std::isfinite(first) || !std::isfinite(second)) {
    return add_text({"no number in " + place.name, place.element}, fmt::format("{}", first),
                    fmt::format("{}", second), at_s);
  }
  in_message_[place.name] = true;
  const auto [known, is_new] = fields_.try_emplace(place.name);
  FieldDifferences& field = known->second;
  const double apart = std::abs(second - first);
  if (!is_new && apart <= field.largest) return;
  field.is_number = true;
  field.largest = apart;
  field.at_s = at_s;
}

void TopicDifferences::add_text(const Place& place, std::string before, std::string now,
                                double at_s) {
  in_message_[place.name] = true;
  const auto [known, is_new] = fields_.try_emplace(place.name);
  if (!is_new) return;
  FieldDifferences& field = known->second;
  field.element = place.element;
  field.at_s = at_s;
  field.before = std::move(before);
  field.now = std::move(now);
}

void TopicDifferences::follow_joints(const MessageType& type, std::span<const std::byte> cdr,
                                     std::size_t run) {
  const TypeDescription* description = describe_type(type.dds_name);
  if (!description) return;
  if (const auto message = cdr_to_json(*description, cdr)) follow_joints(*message, run);
}

void TopicDifferences::follow_joints(const Json& message, std::size_t run) {
  if (const auto points = message.find("points"); points != message.end()) {
    joints_[run].clear();  // another way begins where it will
    for (const Json& point : *points) {
      if (point.contains("positions")) add_joints(point["positions"], run);
    }
  } else if (message.contains("name") && message.contains("position")) {
    add_joints(message["position"], run);
  }
}

void TopicDifferences::add_joints(const Json& joints, std::size_t run) {
  if (!joints.is_array() ||
      !std::ranges::all_of(joints, [](const Json& joint) { return joint.is_number(); })) {
    return;
  }
  const auto now = joints.get<std::vector<double>>();
  std::vector<double>& before = joints_[run];
  for (std::size_t i = 0; i < std::min(before.size(), now.size()); ++i) {
    joint_steps_[run] = std::max(joint_steps_[run], std::abs(now[i] - before[i]));
  }
  before = now;
}

}  // namespace armature
