// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace armature {

/// What the processes of a run have read of each other, held against what they have written.
struct ExchangedSamples {
  struct Unwritten {
    std::string topic, reader;  // the process
    double at_s = 0;            // since the recording began
  };
  std::uint64_t compared = 0;      // samples that are, byte for byte, what their writer recorded
  std::uint64_t numbered = 0;      // those of them that were found by their writer's number
  std::uint64_t unwritten = 0;     // and those that are not
  std::optional<Unwritten> first;  // of these

  ExchangedSamples& operator+=(const ExchangedSamples& more) {
    compared += more.compared;
    numbered += more.numbered;
    unwritten += more.unwritten;
    if (!first) first = more.first;
    return *this;
  }
};

/// Looks for each sample that one process of a joined recording got from another among those that
/// the writer has recorded, by the number that the writer gave it, or by its content where several
/// write the topic: the bytes must be the same, and the samples of one writer must have come in the
/// order in which they were written, none twice. Topics of which the writers have recorded nothing
/// are left out. Compares hashes of 64 bits. Throws std::runtime_error for a file that cannot be
/// read.
ExchangedSamples compare_exchanged(const std::filesystem::path& file);

}  // namespace armature
