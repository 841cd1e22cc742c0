// SPDX-License-Identifier: Apache-2.0
#include "error_relay.hpp"

#include <array>
#include <cctype>
#include <cerrno>
#include <utility>

namespace armature::ik::process {
namespace {

constexpr std::size_t kLongestLine = 4096;
constexpr std::size_t kLastWords = 160;
constexpr int kPieces = 16;  // at a time: who never stops talking must not hold us

}  // namespace

ErrorRelay::ErrorRelay(FileDescriptor from, std::string name)
    : from_{std::move(from)}, to_{std::move(name)} {}

void ErrorRelay::pass_on() {
  for (int piece = 0; piece < kPieces && from_; ++piece) {
    std::array<char, 4096> buffer;
    const ssize_t n = read(from_.get(), buffer.data(), buffer.size());
    if (n < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (n <= 0) return from_.reset();
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
      if (buffer[i] != '\n') begun_ += buffer[i];
      if (buffer[i] == '\n' || begun_.size() >= kLongestLine) {
        pass_on_line(std::exchange(begun_, ""));
      }
    }
    if (static_cast<std::size_t>(n) < buffer.size()) return;
  }
}

void ErrorRelay::finish() {
  pass_on();
  if (!begun_.empty()) pass_on_line(std::exchange(begun_, ""));
  to_.tell_dropped();
}

void ErrorRelay::pass_on_line(const std::string& line) {
  to_.put(line);
  std::string words = line.substr(0, kLastWords);
  bool blank = true;
  for (char& c : words) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isprint(byte) == 0) c = '?';
    blank = blank && std::isspace(byte) != 0;
  }
  if (!blank) last_words_ = std::move(words);
}

}  // namespace armature::ik::process
