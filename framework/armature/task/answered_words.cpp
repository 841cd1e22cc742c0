// SPDX-License-Identifier: Apache-2.0
#include "armature/task/answered_words.hpp"

#include <algorithm>
#include <cstddef>

namespace armature {
namespace {

constexpr std::size_t kKept = 64;
constexpr Duration kToldAgainWithin = seconds(1.0);  // `armature operator` does so after 0.1 s

bool is_same(const OperatorCommand& a, const OperatorCommand& b) {
  return a.id == b.id && a.word == b.word && a.step == b.step;
}

}  // namespace

bool AnsweredWords::knows(const OperatorCommand& word, Time now) {
  const auto known =
      std::ranges::find_if(words_, [&](const Word& before) { return is_same(before.said, word); });
  if (known == words_.end()) return false;
  const bool may_be_new = known->is_passed || now - known->told > kToldAgainWithin;
  if (makes_safe(word.word) && may_be_new) {
    words_.erase(known);
    return false;
  }
  known->told = now;
  tell(known->answer);
  return true;
}

void AnsweredWords::add(const OperatorCommand& word, const Expected<void>& obeyed, Time now) {
  if (obeyed) {
    for (Word& before : words_) before.is_passed = true;
  }
  if (words_.size() == kKept) words_.pop_front();
  words_.push_back({.said = word,
                    .answer = {.id = word.id, .text = obeyed ? "" : obeyed.error().text},
                    .told = now});
  tell(words_.back().answer);
}

void AnsweredWords::tell(const Answer& answer) {
  if (std::ranges::find(waiting_, answer) != waiting_.end()) return;
  if (waiting_.size() == kKept) waiting_.pop_front();
  waiting_.push_back(answer);
}

const AnsweredWords::Answer& AnsweredWords::next() {
  if (!waiting_.empty()) {
    told_ = waiting_.front();
    waiting_.pop_front();
  }
  return told_;
}

}  // namespace armature
