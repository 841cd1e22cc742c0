// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <exception>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

// Laws that every plugin of a kind keeps, as functions without a test framework, so that one table
// serves tests and `armature plugin verify`.
namespace armature ARMATURE_EXPORT {

/// One answer that breaks a law.
struct LawViolation {
  std::string what;      // "the normal's length: 0.98, not 1 to 1e-09"
  std::string question;  // what was asked, such that it can be asked again; may be empty
};

/// What came of checking one law.
struct LawReport {
  std::string skipped;                   // why the law does not apply; empty: it was checked
  std::string note;                      // what was counted on the way
  int questions = 0;                     // how many were asked
  int failed = 0;                        // how many claims did not hold
  std::vector<LawViolation> violations;  // the first few of them

  bool kept() const { return failed == 0; }
};

/// What a law says with: it asks questions and makes claims about the answers. Every claim returns
/// whether it holds, so that a law can end where the next claim makes no sense.
class LawCheck {
 public:
  /// The question that the next claims are about, in words with which somebody can ask it again
  /// ("seed 17, round 3").
  void asks(std::string question);
  /// The law does not apply to this subject; to be said before a claim.
  void skip(std::string why) { report_.skipped = std::move(why); }

  /// `claim` says what holds: "the path ends at rest".
  bool that(bool holds, std::string_view claim);
  /// `value <= bound`; false for a NaN. `quantity` names the value.
  bool at_most(double value, double bound, std::string_view quantity);
  /// `|value - expected| <= tolerance`; false for a NaN.
  bool near(double value, double expected, double tolerance, std::string_view quantity);
  /// Equal by ==, to the bit for numbers.
  template <class A, class B>
  bool equal(const A& value, const B& expected, std::string_view quantity) {
    if (value == expected) return true;
    return is_not(quantity, text_of(value), text_of(expected));
  }
  /// `answer` is an Expected that holds a value; `question` names what was asked.
  template <class Answer>
  bool answered(const Answer& answer, std::string_view question) {
    if (answer) return true;
    std::string fault{question};  // appended to: GCC 12 warns of a + b without a reason
    return violated(fault.append(" is refused: ").append(answer.error().text));
  }
  /// `answer` is an Expected that holds a reason with words.
  template <class Answer>
  bool refused(const Answer& answer, std::string_view question) {
    std::string fault{question};
    if (answer) return violated(fault.append(" is answered, not refused"));
    return that(!answer.error().text.empty(), "a refusal says why");
  }
  /// `answer` is an Expected that holds exactly this reason.
  template <class Answer>
  bool refused_with(const Answer& answer, std::string_view reason) {
    if (answer) return violated("answered, not refused with '" + std::string{reason} + "'");
    return equal(answer.error().text, reason, "the reason");
  }
  /// Counts a violation and keeps the first few; false.
  bool violated(std::string what);

  const LawReport& report() const { return report_; }

 private:
  /// Empty for what has no text.
  template <class Value>
  static std::string text_of(const Value& value) {
    if constexpr (std::convertible_to<const Value&, std::string_view>) {
      return std::string{std::string_view{value}};
    } else if constexpr (std::integral<Value>) {
      return std::to_string(value);
    } else if constexpr (std::floating_point<Value>) {
      return number_text(value);
    } else {
      return "";
    }
  }
  static std::string number_text(double value);
  bool is_not(std::string_view quantity, const std::string& value, const std::string& expected);

  LawReport report_;
  std::string question_;
};

/// A law of a kind: a sentence with the function that checks it on a subject, which is a plugin
/// that was made, with all that the law has to know of it.
template <class Subject>
struct Law {
  std::string_view name;  // "StartsWithTheFirstMeasurement"
  std::string_view says;  // in short, for a table
  void (*check)(const Subject&, LawCheck&);
};

/// Checks a law. An exception out of the plugin breaks it.
template <class Subject>
LawReport check_law(const Law<Subject>& law, const Subject& subject) {
  LawCheck check;
  try {
    law.check(subject, check);
  } catch (const std::exception& error) {
    check.violated("it throws: " + std::string{error.what()});
  } catch (...) {
    check.violated("it throws what is no std::exception");
  }
  return check.report();
}

}  // namespace armature
