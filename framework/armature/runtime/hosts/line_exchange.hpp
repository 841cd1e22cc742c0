// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// One end of a talk between two programs, in lines of text. What carries its messages may lose,
/// double and reorder them: each line arrives once and in order, as long as messages get through at
/// all. A message has all lines that the other end has not acknowledged. Not for several threads.
class LineExchange {
 public:
  /// `own`: one word that no other end of a talk has, as a random number is.
  explicit LineExchange(std::string own) : own_{std::move(own)} {}

  const std::string& own() const { return own_; }
  /// The end that it talks to: the first one that has answered, or asked for anybody; or "".
  const std::string& other() const { return other_; }

  /// Forgets the other end, what it said and what it was to be told, and never hears it again.
  void turn_away();

  /// A line end in `line` arrives as a blank, and so does an empty line; of one that is longer than
  /// 8,000 bytes the beginning arrives, with "..." behind it.
  void send(std::string line);
  /// How many lines wait to be acknowledged.
  std::size_t waiting() const { return unacknowledged_.size(); }
  std::optional<std::string> receive();

  /// What the other end is to be told now; of many lines the first ones.
  std::string message() const;
  /// Takes a message that came at `now`. False, and nothing of it is taken, when it is for another
  /// end or from one, or no message of an exchange.
  bool take(std::string_view message, Time now);
  /// Whether a third one asks for anybody, whom it does not hear.
  bool is_asked_by_third() const { return is_asked_by_third_; }
  /// When the last message of the other end came.
  Time heard() const { return heard_; }

 private:
  std::string own_, other_;
  std::deque<std::string> unacknowledged_, received_;
  std::uint64_t acknowledged_ = 0;  // of our lines
  std::uint64_t taken_ = 0;         // of the other's lines
  bool is_asked_by_third_ = false;
  Time heard_;
  std::set<std::string, std::less<>> turned_away_;
};

}  // namespace armature
