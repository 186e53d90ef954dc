#include "base/stretched_hash.h"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/rand.h>

#include <vector>

#include "base/codes.h"
#include "base/hex.h"
#include "base/tr.h"

namespace trephine {

std::string stretchedHash(std::string_view text, std::string_view salt, int iterations, int bytes) {
  std::vector<std::uint8_t> digest(std::size_t(bytes), 0);
  const bool made =
      PKCS5_PBKDF2_HMAC(text.data(), int(text.size()),
                        reinterpret_cast<const unsigned char*>(salt.data()), int(salt.size()),
                        iterations, EVP_sha256(), bytes, digest.data()) == 1;
  return made ? hexOf(digest) : std::string();
}

std::string keyedHash(std::string_view text, std::string_view key) {
  constexpr std::size_t kKept = 16;
  std::vector<std::uint8_t> digest(EVP_MAX_MD_SIZE, 0);
  unsigned size = 0;
  const bool made = HMAC(EVP_sha256(), key.data(), int(key.size()),
                         reinterpret_cast<const unsigned char*>(text.data()), text.size(),
                         digest.data(), &size) != nullptr;
  if (!made || size < kKept) return {};
  digest.resize(kKept);
  return hexOf(digest);
}

bool sameSecret(std::string_view a, std::string_view b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

Result<std::string> randomHex(int bytes) {
  std::vector<std::uint8_t> random(std::size_t(bytes), 0);
  if (RAND_bytes(random.data(), bytes) != 1) {
    return Error{code::kNoRandomNumbers, tr("The system gives no random numbers"), "",
                 tr("Try again")};
  }
  return hexOf(random);
}

}  // namespace trephine
