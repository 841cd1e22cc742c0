// SPDX-License-Identifier: Apache-2.0
#include "armature/recording/hash_chain.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <cstring>
#include <stdexcept>

#include "armature/recording/mapped_file.hpp"

namespace armature {
namespace {

constexpr const char* kNoSha256 = "OpenSSL offers no SHA-256";
constexpr std::size_t kNumberAt = sizeof(std::uint32_t) + ChainRecord::kName.size();
constexpr std::size_t kHashAt = kNumberAt + sizeof(std::uint64_t);
constexpr std::size_t kBodyBytes = kHashAt + sizeof(Hash);
constexpr std::size_t kHeadBytes = 1 + sizeof(std::uint64_t);  // op and length

/// Op, length and name, which are the same in all of them.
std::vector<std::byte> beginning() {
  std::vector<std::byte> bytes;
  const auto append = [&](const void* from, std::size_t size) {
    const auto* begin = static_cast<const std::byte*>(from);
    bytes.insert(bytes.end(), begin, begin + size);
  };
  const std::uint64_t length = kBodyBytes;
  const auto name_length = static_cast<std::uint32_t>(ChainRecord::kName.size());
  append(&ChainRecord::kOp, sizeof ChainRecord::kOp);
  append(&length, sizeof length);
  append(&name_length, sizeof name_length);
  append(ChainRecord::kName.data(), ChainRecord::kName.size());
  return bytes;
}

}  // namespace

std::string to_hex(const Hash& hash) {
  std::string hex;
  for (const std::byte byte : hash) hex += fmt::format("{:02x}", std::to_integer<unsigned>(byte));
  return hex;
}

std::string sha256_of_file(const std::filesystem::path& file) {
  const MappedFile mapped{file};
  Hash hash{};
  if (EVP_Digest(mapped.bytes().data(), mapped.bytes().size(),
                 reinterpret_cast<unsigned char*>(hash.data()), nullptr, EVP_sha256(),
                 nullptr) != 1) {
    throw std::runtime_error{kNoSha256};
  }
  return to_hex(hash);
}

struct HashChain::Digest {
  EVP_MD_CTX* context = EVP_MD_CTX_new();
  ~Digest() { EVP_MD_CTX_free(context); }
};

HashChain::HashChain() : digest_{std::make_unique<Digest>()} { stand_on(Hash{}); }

HashChain::~HashChain() = default;

void HashChain::stand_on(const Hash& before) {
  if (EVP_DigestInit_ex(digest_->context, EVP_sha256(), nullptr) != 1) {
    throw std::runtime_error{kNoSha256};
  }
  add(before);
}

void HashChain::add(std::span<const std::byte> bytes) {
  EVP_DigestUpdate(digest_->context, bytes.data(), bytes.size());
}

Hash HashChain::end_link() {
  Hash hash{};
  EVP_DigestFinal_ex(digest_->context, reinterpret_cast<unsigned char*>(hash.data()), nullptr);
  stand_on(hash);
  return hash;
}

std::vector<std::byte> ChainRecord::bytes() const {
  std::vector<std::byte> bytes = beginning();
  bytes.resize(kHeadBytes + kBodyBytes);
  std::memcpy(&bytes[kHeadBytes + kNumberAt], &number, sizeof number);
  std::memcpy(&bytes[kHeadBytes + kHashAt], hash.data(), hash.size());
  return bytes;
}

std::optional<ChainRecord> ChainRecord::parse(std::span<const std::byte> body) {
  static const std::vector<std::byte> kBeginning = beginning();
  const auto name = std::span{kBeginning}.subspan(kHeadBytes);
  if (body.size() != kBodyBytes || std::memcmp(body.data(), name.data(), name.size()) != 0) {
    return std::nullopt;
  }
  ChainRecord record;
  std::memcpy(&record.number, &body[kNumberAt], sizeof record.number);
  std::memcpy(record.hash.data(), &body[kHashAt], record.hash.size());
  return record;
}

std::optional<std::size_t> ChainRecord::find(std::span<const std::byte> bytes) {
  static const std::vector<std::byte> kBeginning = beginning();
  const void* found = memmem(bytes.data(), bytes.size(), kBeginning.data(), kBeginning.size());
  if (found == nullptr) return std::nullopt;
  return static_cast<std::size_t>(static_cast<const std::byte*>(found) - bytes.data());
}

}  // namespace armature
