// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "armature/task/procedure.hpp"
#include "armature/values/expected.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// The last 64 words of operators with their answers. Who has not seen the answer tells his word
/// again under the same number: it is answered again, and not obeyed again, whatever others have
/// said meanwhile.
class AnsweredWords {
 public:
  struct Answer {
    std::uint64_t id = 0;
    std::string text;  // why the word was refused; empty: it was obeyed
    bool operator==(const Answer&) const = default;
  };

  /// True of a word that was answered before: number, word and step are the same. Its answer waits
  /// to be told once more. A `pause` or `abort` counts as a new word when another one was obeyed
  /// since, or when nobody has told it for 1 s: a program that gives every word the number 0 can
  /// always stop the arm.
  bool knows(const OperatorCommand& word, Time now);
  /// The answer waits to be told.
  void add(const OperatorCommand& word, const Expected<void>& obeyed, Time now);
  /// An answer waits to be told.
  bool waits() const { return !waiting_.empty(); }
  /// The answer to tell now: of those that wait the oldest, else the one that was told last.
  const Answer& next();

 private:
  struct Word {
    OperatorCommand said;
    Answer answer;
    Time told;
    bool is_passed = false;  // another word was obeyed since
  };
  void tell(const Answer& answer);

  std::deque<Word> words_;
  std::deque<Answer> waiting_;
  Answer told_;
};

}  // namespace armature
