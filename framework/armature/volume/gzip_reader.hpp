// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <istream>
#include <memory>
#include <span>
#include <string>

#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// Unpacks what gzip compressed, a piece at a time: a small file can hold a huge one.
class GzipReader {
 public:
  /// Of what follows in `in`, which lives longer.
  explicit GzipReader(std::istream& in);
  ~GzipReader();
  GzipReader(const GzipReader&) = delete;
  GzipReader& operator=(const GzipReader&) = delete;

  /// Fills `bytes` (fewer than 2^32), and returns how many there were: less only at the end.
  /// Refuses what is not gzip or damaged, and what ends before its own end.
  Expected<std::size_t> read(std::span<char> bytes);

 private:
  struct State;
  std::istream& in_;
  std::unique_ptr<State> state_;
};

}  // namespace armature
