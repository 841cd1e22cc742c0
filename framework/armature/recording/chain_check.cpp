// SPDX-License-Identifier: Apache-2.0
#include "armature/recording/chain_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "armature/recording/mcap_cursor.hpp"

namespace armature {

using mcap::Op;

ChainCheck::ChainCheck(std::span<const std::byte> file) : file_{file} { skip(mcap::kMagic.size()); }

void ChainCheck::take(std::uint8_t op, std::span<const std::byte> body, std::uint64_t end) {
  if (closed_) {
    places_wrong_ = !is_right_place(op, body) || places_wrong_;
    return skip(end);
  }
  if (const auto told = op == ChainRecord::kOp ? ChainRecord::parse(body) : std::nullopt) {
    end_link(*told);
    at_ = link_begin_ = end;
    so_far_.bytes = end;
    return;
  }
  if (in_summary_) add_to_group(op, end);
  switch (static_cast<Op>(op)) {
    case Op::header: content_ = "the header"; break;
    case Op::chunk: {
      content_ = fmt::format("chunk {}", ++chunks_);
      McapCursor cursor{body};
      cursor.time();
      last_ = std::max(last_, cursor.time());
      break;
    }
    case Op::attachment: content_ = "an attachment"; break;
    case Op::metadata: content_ = "metadata"; break;
    case Op::data_end: content_ = "the summary"; break;
    default: break;
  }
  skip(end);
}

void ChainCheck::skip(std::uint64_t end) {
  chain_.add(file_.subspan(at_, end - at_));
  at_ = end;
}

void ChainCheck::add_to_group(std::uint8_t op, std::uint64_t end) {
  if (groups_.empty() || groups_.back().op != op) groups_.push_back({.op = op, .begin = at_});
  groups_.back().size = end - groups_.back().begin;
}

bool ChainCheck::is_right_place(std::uint8_t op, std::span<const std::byte> body) {
  McapCursor cursor{body};
  const bool all_placed = placed_ == groups_.size();
  if (static_cast<Op>(op) == Op::summary_offset && !all_placed && !has_footer_) {
    const Group& group = groups_[placed_++];
    return cursor.number<std::uint8_t>() == group.op &&
           cursor.number<std::uint64_t>() == group.begin &&
           cursor.number<std::uint64_t>() == group.size && cursor.ok() && cursor.left().empty();
  }
  if (static_cast<Op>(op) != Op::footer || !all_placed || has_footer_ || groups_.empty()) {
    return false;
  }
  has_footer_ = true;
  return cursor.number<std::uint64_t>() == groups_.front().begin &&
         cursor.number<std::uint64_t>() == so_far_.bytes && cursor.number<std::uint32_t>() != 0 &&
         cursor.ok() && cursor.left().empty();
}

std::string ChainCheck::what() const { return content_.empty() ? "a link" : content_; }

void ChainCheck::end_link(const ChainRecord& told) {
  ++so_far_.links;
  const Hash hash = chain_.end_link();
  if (hash != told.hash) {
    so_far_.changes.push_back(fmt::format("{}, within the {} bytes from byte {}", what(),
                                          at_ - link_begin_, link_begin_));
  } else if (told.number != expected_) {
    so_far_.changes.push_back(
        fmt::format("link {} stands where link {} was, at byte {}", told.number, expected_, at_));
  }
  // Only what was changed shall be named, so the next link is held to what is written here.
  chain_.stand_on(told.hash);
  expected_ = told.number + 1;
  so_far_.head = to_hex(told.hash);
  so_far_.chunks = chunks_;
  so_far_.until = last_;
  closed_ = in_summary_;
  content_.clear();
}

McapChain ChainCheck::result() const {
  McapChain result = so_far_;
  using Verdict = McapChain::Verdict;
  const auto end = file_.last(std::min(file_.size(), mcap::kMagic.size()));
  const bool has_end = std::memcmp(end.data(), mcap::kMagic.data(), end.size()) == 0;
  const bool is_complete = closed_ && has_footer_;
  if (result.links > 0 && (places_wrong_ || (has_end && !is_complete))) {
    result.changes.push_back(fmt::format("{}, within the {} bytes from byte {}",
                                         closed_ ? "what says where things stand" : what(),
                                         file_.size() - result.bytes, result.bytes));
  }
  if (result.links == 0) {
    result.verdict = Verdict::none;
  } else if (!result.changes.empty()) {
    result.verdict = Verdict::changed;
  } else {
    result.verdict = is_complete ? Verdict::whole : Verdict::cut;
  }
  return result;
}

}  // namespace armature
