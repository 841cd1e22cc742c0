// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "file_descriptor.hpp"
#include "standard_error.hpp"

namespace armature::ik::process {

/// Passes on what a program writes to its standard error: to ours, line by line, each behind its
/// name. It is read while the program is asked or ended, not in between; a program that says much
/// meanwhile waits. We wait for nobody who reads ours.
class ErrorRelay {
 public:
  /// `from` does not block.
  ErrorRelay(FileDescriptor from, std::string name);

  int descriptor() const { return from_.get(); }  // -1: closed
  /// Passes on what there is to read.
  void pass_on();
  /// The same, and the last line even when it has no end.
  void finish();

  /// The last line that was not blank, fit to be printed and cut; empty: none since `forget`.
  const std::string& last_words() const { return last_words_; }
  void forget() { last_words_.clear(); }

 private:
  void pass_on_line(const std::string& line);

  FileDescriptor from_;
  StandardError to_;
  std::string begun_, last_words_;
};

}  // namespace armature::ik::process
