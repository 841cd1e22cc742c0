// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace armature ARMATURE_EXPORT {

/// A SHA-256.
using Hash = std::array<std::byte, 32>;

/// As 64 hexadecimal digits.
std::string to_hex(const Hash& hash);
/// Of a whole file, as sha256sum prints it. Throws std::runtime_error for one that cannot be read.
std::string sha256_of_file(const std::filesystem::path& file);

/// A chain of hashes over the bytes of a file. The hash of a link is the SHA-256 of the hash of the
/// link before (of the first: 32 zero bytes) and the bytes of the link: nothing can be changed,
/// left out or put in without every hash from there on being another.
class HashChain {
 public:
  /// Throws std::runtime_error when OpenSSL offers no SHA-256.
  HashChain();
  ~HashChain();
  HashChain(const HashChain&) = delete;
  HashChain& operator=(const HashChain&) = delete;

  void add(std::span<const std::byte> bytes);
  /// The hash of what was added since the last link, which is one, too, now.
  Hash end_link();
  /// The running link stands on `before` instead of on the link that was ended last. Nothing has
  /// been added to it yet.
  void stand_on(const Hash& before);

 private:
  struct Digest;
  std::unique_ptr<Digest> digest_;
};

/// What stands in a recording behind each of its links: a record that other readers of MCAP pass
/// over, as the format bids them with those from 0x80 on.
struct ChainRecord {
  static constexpr std::uint8_t kOp = 0x80;
  static constexpr std::string_view kName = "armature.chain";

  std::uint64_t number = 0;  // of the link, from 1
  Hash hash{};

  /// The whole record, as it stands in the file.
  std::vector<std::byte> bytes() const;
  /// Of what follows op and length; nothing for a record of somebody else.
  static std::optional<ChainRecord> parse(std::span<const std::byte> body);
  /// Where the next one begins in `bytes`; nothing: there is none.
  static std::optional<std::size_t> find(std::span<const std::byte> bytes);
};

}  // namespace armature
