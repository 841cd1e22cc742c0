// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "armature/messages/message_type.hpp"

namespace armature {

/// How a field of a topic's messages differs between two runs; all elements of an array together.
struct FieldDifferences {
  std::uint64_t messages = 0;  // that differ in it
  bool is_number = false;
  double largest = 0;       // of numbers
  double at_s = 0;          // where the largest is; of others the first
  std::string before, now;  // of others: the first values
  std::string element;      // of others: where these stand, "data[399]"
};

/// How the messages of one topic differ between two runs, and how far joints jump in each.
class TopicDifferences {
 public:
  /// Compares two messages that stand for each other, `at_s` after the beginning.
  void compare(const MessageType& type, std::span<const std::byte> before,
               std::span<const std::byte> now, double at_s);
  /// Counts a message that only one of the runs has, and follows its joints.
  void add_only_before(const MessageType& type, std::span<const std::byte> cdr);
  void add_only_now(const MessageType& type, std::span<const std::byte> cdr);

  std::uint64_t messages() const { return messages_; }
  std::uint64_t differing() const { return differing_; }
  std::uint64_t only_before() const { return only_before_; }
  std::uint64_t only_now() const { return only_now_; }
  /// By name: "position[]", "points[].positions[]"; "no number in position[]" where one of two is
  /// NaN or infinite, "elements of position" where one has more.
  const std::map<std::string, FieldDifferences>& fields() const { return fields_; }
  /// The largest change of a joint from one message, or one point of a trajectory, to the next one
  /// of the same run [rad or m], before and now.
  const std::array<double, 2>& joint_steps() const { return joint_steps_; }

 private:
  using Json = nlohmann::ordered_json;

  struct Place {
    std::string name;     // as fields() has it
    std::string element;  // the same with the numbers of elements: "points[2].positions[0]"
  };

  void walk(const Json& before, const Json& now, const Place& place, double at_s);
  void walk_array(const Json& before, const Json& now, const Place& place, double at_s);
  void add(const Place& place, const Json& before, const Json& now, double at_s);
  void add_text(const Place& place, std::string before, std::string now, double at_s);
  void follow_joints(const MessageType& type, std::span<const std::byte> cdr, std::size_t run);
  void follow_joints(const Json& message, std::size_t run);
  void add_joints(const Json& joints, std::size_t run);

  std::uint64_t messages_ = 0, differing_ = 0, only_before_ = 0, only_now_ = 0;
  std::map<std::string, FieldDifferences> fields_;
  std::map<std::string, bool> in_message_;  // fields that differ in the running message
  std::array<std::vector<double>, 2> joints_;
  std::array<double, 2> joint_steps_{};
};

}  // namespace armature
