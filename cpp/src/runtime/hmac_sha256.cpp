// The low-level SHA-256 of libcrypto: its newer interfaces allocate for each message.
#define OPENSSL_SUPPRESS_DEPRECATED
#include "saras/runtime/hmac_sha256.hpp"

#include <openssl/crypto.h>
#include <openssl/sha.h>

namespace saras {
namespace {

constexpr std::size_t kBlock = 64;

}  // namespace

/// SHA-256 after the first block of the inner and the outer hash (RFC 2104).
struct HmacSha256::Contexts {
  SHA256_CTX inner;
  SHA256_CTX outer;
};

HmacSha256::HmacSha256() : contexts_(std::make_unique<Contexts>()) { set_key({}); }
HmacSha256::~HmacSha256() { OPENSSL_cleanse(contexts_.get(), sizeof(Contexts)); }

void HmacSha256::set_key(const HmacKey& key) noexcept {
  std::array<std::uint8_t, kBlock> inner;
  std::array<std::uint8_t, kBlock> outer;
  inner.fill(0x36);
  outer.fill(0x5c);
  for (std::size_t i = 0; i < key.size(); ++i) {
    inner[i] = static_cast<std::uint8_t>(inner[i] ^ key[i]);
    outer[i] = static_cast<std::uint8_t>(outer[i] ^ key[i]);
  }
  SHA256_Init(&contexts_->inner);
  SHA256_Update(&contexts_->inner, inner.data(), inner.size());
  SHA256_Init(&contexts_->outer);
  SHA256_Update(&contexts_->outer, outer.data(), outer.size());
  OPENSSL_cleanse(inner.data(), inner.size());
  OPENSSL_cleanse(outer.data(), outer.size());
}

HmacTag HmacSha256::tag(const std::uint8_t* data, std::size_t size) const noexcept {
  HmacTag digest;
  SHA256_CTX context = contexts_->inner;
  SHA256_Update(&context, data, size);
  SHA256_Final(digest.data(), &context);
  context = contexts_->outer;
  SHA256_Update(&context, digest.data(), digest.size());
  SHA256_Final(digest.data(), &context);
  return digest;
}

bool HmacSha256::same(const std::uint8_t* a, const std::uint8_t* b, std::size_t size) noexcept {
  return CRYPTO_memcmp(a, b, size) == 0;
}

}  // namespace saras
