// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <string>
#include <string_view>

namespace armature {

class IdlError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Words, texts in quotes and single punctuation characters; comments, white space and preprocessor
/// lines vanish.
class IdlTokens {
 public:
  /// `file` is what mistakes are told with: "weather.idl:3: ...".
  IdlTokens(std::string_view text, std::string_view file) : text_{text}, file_{file} { advance(); }

  std::string_view peek() const { return token_; }
  bool at_end() const { return token_.empty(); }

  std::string_view take() {
    if (at_end()) fail("unexpected end of the file");
    const std::string_view taken = token_;
    taken_line_ = token_line_;
    advance();
    return taken;
  }
  bool take_if(std::string_view expected) {
    if (at_end() || token_ != expected) return false;
    take();
    return true;
  }
  void expect(std::string_view expected) {
    if (at_end()) fail("unexpected end of the file");
    if (!take_if(expected)) {
      fail("expected '" + std::string{expected} + "' before '" + std::string{token_} + "'");
    }
  }
  std::string_view identifier() {
    if (at_end()) fail("unexpected end of the file");
    if (!is_word(token_.front()) || std::isdigit(static_cast<unsigned char>(token_.front()))) {
      fail("expected a name before '" + std::string{token_} + "'");
    }
    return take();
  }
  /// Of the token that comes next.
  [[noreturn]] void fail(const std::string& what) const { fail_at(token_line_, what); }
  /// Of the token that was taken last.
  [[noreturn]] void fail_taken(const std::string& what) const { fail_at(taken_line_, what); }

 private:
  [[noreturn]] void fail_at(int line, const std::string& what) const {
    throw IdlError{std::string{file_} + ":" + std::to_string(line) + ": " + what};
  }
  static bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

  void skip_to(std::string_view end) {
    for (; at_ < text_.size() && text_.substr(at_, end.size()) != end; ++at_) {
      if (text_[at_] == '\n') ++line_;
    }
  }
  void skip_blanks() {
    while (at_ < text_.size()) {
      if (text_[at_] == '#' || text_.substr(at_, 2) == "//") {
        skip_to("\n");
      } else if (text_.substr(at_, 2) == "/*") {
        skip_to("*/");
        at_ += 2;
      } else if (std::isspace(static_cast<unsigned char>(text_[at_]))) {
        if (text_[at_++] == '\n') ++line_;
      } else {
        return;
      }
    }
  }
  void advance() {
    skip_blanks();
    at_ = std::min(at_, text_.size());
    token_line_ = line_;
    std::size_t length = 0;
    while (at_ + length < text_.size() && is_word(text_[at_ + length])) ++length;
    if (length == 0 && at_ < text_.size()) length = length_of_mark();
    token_ = text_.substr(at_, length);
    at_ += length;
  }
  std::size_t length_of_mark() const {
    if (text_[at_] != '"') return text_.substr(at_, 2) == "::" ? 2 : 1;
    const std::size_t end = text_.find_first_of("\"\n", at_ + 1);
    return end == std::string_view::npos || text_[end] == '\n' ? 1 : end + 1 - at_;
  }

  std::string_view text_;
  std::string_view file_;
  std::string_view token_;
  std::size_t at_ = 0;
  int line_ = 1;
  int token_line_ = 1;
  int taken_line_ = 1;
};

}  // namespace armature
