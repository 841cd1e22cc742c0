// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/hosts/line_exchange.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include "armature/values/utf8.hpp"

namespace armature {
namespace {

constexpr std::string_view kAnybody = "*", kCut = "...";
constexpr std::size_t kLongestMessage = 32000;
constexpr std::size_t kLongestLine = 8000;  // so that there is one in every message

std::string_view first_part(std::string_view& text, char end) {
  const std::size_t size = std::min(text.find(end), text.size());
  const std::string_view part = text.substr(0, size);
  text.remove_prefix(std::min(size + 1, text.size()));
  return part;
}

std::optional<std::uint64_t> number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = failed == std::errc{} && end == text.data() + text.size();
  return whole ? std::optional{value} : std::nullopt;
}

}  // namespace

/// The other end counts lines by their ends.
void LineExchange::send(std::string line) {
  if (line.size() > kLongestLine) {
    line.resize(beginning_of(line, kLongestLine - kCut.size()).size());
    line += kCut;
  }
  std::ranges::replace(line, '\n', ' ');
  if (line.empty()) line = " ";
  unacknowledged_.push_back(std::move(line));
}

std::optional<std::string> LineExchange::receive() {
  if (received_.empty()) return std::nullopt;
  std::string line = std::move(received_.front());
  received_.pop_front();
  return line;
}

void LineExchange::turn_away() {
  turned_away_.insert(other_);
  std::set<std::string, std::less<>> all = std::move(turned_away_);
  *this = LineExchange{std::move(own_)};
  turned_away_ = std::move(all);
}

/// "TO FROM TAKEN FIRST" and the lines from number FIRST, counted from 1.
std::string LineExchange::message() const {
  std::string text = (other_.empty() ? std::string{kAnybody} : other_) + ' ' + own_ + ' ' +
                     std::to_string(taken_) + ' ' + std::to_string(acknowledged_ + 1);
  for (const std::string& line : unacknowledged_) {
    if (text.size() + line.size() > kLongestMessage) break;
    text += '\n' + line;
  }
  return text;
}

bool LineExchange::take(std::string_view message, Time now) {
  std::string_view head = first_part(message, '\n');
  const std::string_view to = first_part(head, ' '), from = first_part(head, ' ');
  const auto taken = number(first_part(head, ' ')), first = number(head);
  if (!taken || !first || from.empty() || (to != own_ && to != kAnybody)) return false;
  if (turned_away_.contains(from)) return false;
  if (other_.empty()) other_ = from;
  is_asked_by_third_ = is_asked_by_third_ || (from != other_ && to == kAnybody);
  if (from != other_ || *taken > acknowledged_ + unacknowledged_.size()) return false;
  heard_ = std::max(heard_, now);
  for (; acknowledged_ < *taken; ++acknowledged_) unacknowledged_.pop_front();
  for (std::uint64_t line = *first; !message.empty(); ++line) {
    const std::string_view text = first_part(message, '\n');
    if (line != taken_ + 1) continue;
    received_.emplace_back(text);
    ++taken_;
  }
  return true;
}

}  // namespace armature
