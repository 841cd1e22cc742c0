// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "armature/recording/hash_chain.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// What the chain of hashes in a recording says of it.
struct McapChain {
  enum class Verdict {
    none,    // there is no chain: another program wrote it
    whole,   // it is as it was written, from its first byte to its summary
    cut,     // it is as it was written as far as the chain goes, and its end is missing
    changed  // it is not as it was written
  };
  Verdict verdict = Verdict::none;
  std::uint64_t links = 0;
  std::string head;                     // the hash of the last one, in hexadecimal digits
  std::vector<std::string> changes;     // "chunk 3, within the 4133 bytes from byte 8232"
  std::uint64_t chunks = 0, bytes = 0;  // that the links are of
  Time until;                           // the last log time of these chunks
};

/// Follows the chain of a recording, record by record.
class ChainCheck {
 public:
  explicit ChainCheck(std::span<const std::byte> file);

  /// The next bytes of the file, to byte `end`: a record, with `body` behind its op and length.
  void take(std::uint8_t op, std::span<const std::byte> body, std::uint64_t end);
  /// Bytes to `end` that are no record.
  void skip(std::uint64_t end);
  /// What follows belongs to the summary.
  void data_ended() { in_summary_ = true; }
  McapChain result() const;

 private:
  struct Group {  // of records of one kind in the summary
    std::uint8_t op = 0;
    std::uint64_t begin = 0, size = 0;
  };

  void end_link(const ChainRecord& told);
  void add_to_group(std::uint8_t op, std::uint64_t end);
  /// Behind the last link: where the groups of the summary stand, and nothing else.
  bool is_right_place(std::uint8_t op, std::span<const std::byte> body);
  std::string what() const;

  std::span<const std::byte> file_;
  HashChain chain_;
  McapChain so_far_;
  std::uint64_t at_ = 0;          // so much of the file was taken
  std::uint64_t link_begin_ = 0;  // of the running link
  std::uint64_t expected_ = 1;    // number of the next link
  std::uint64_t chunks_ = 0;      // among what was taken
  Time last_;                     // log time in them
  std::string content_;           // of the running link
  bool in_summary_ = false, closed_ = false, has_footer_ = false, places_wrong_ = false;
  std::vector<Group> groups_;
  std::size_t placed_ = 0;  // so many of them
};

}  // namespace armature
