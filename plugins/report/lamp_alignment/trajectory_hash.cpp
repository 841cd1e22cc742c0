// SPDX-License-Identifier: Apache-2.0
#include "trajectory_hash.hpp"

#include <fmt/core.h>
#include <openssl/evp.h>

#include <array>
#include <bit>
#include <stdexcept>

namespace armature::report::lamp_alignment {

static_assert(std::endian::native == std::endian::little, "samples are hashed as they are stored");

struct TrajectoryHash::Digest {
  EVP_MD_CTX* context = EVP_MD_CTX_new();
  Digest() {
    if (!context || EVP_DigestInit_ex(context, EVP_sha256(), nullptr) != 1) {
      throw std::runtime_error("OpenSSL offers no SHA-256");
    }
  }
  ~Digest() { EVP_MD_CTX_free(context); }
  Digest(const Digest&) = delete;
  Digest& operator=(const Digest&) = delete;
};

TrajectoryHash::TrajectoryHash() : digest_{std::make_unique<Digest>()} {}
TrajectoryHash::~TrajectoryHash() = default;

void TrajectoryHash::add(Time stamp, std::span<const double> joints) {
  EVP_DigestUpdate(digest_->context, &stamp.ns, sizeof stamp.ns);
  EVP_DigestUpdate(digest_->context, joints.data(), joints.size_bytes());
}

std::string TrajectoryHash::hex() const {
  Digest copy;
  EVP_MD_CTX_copy_ex(copy.context, digest_->context);
  std::array<unsigned char, 32> bytes{};
  EVP_DigestFinal_ex(copy.context, bytes.data(), nullptr);
  std::string text;
  for (const unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

}  // namespace armature::report::lamp_alignment
