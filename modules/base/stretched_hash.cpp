#include "base/stretched_hash.h"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/rand.h>

#include <vector>

#include "base/hex.h"

namespace trephine {

std::string stretchedHash(std::string_view text, std::string_view salt, int iterations, int bytes) {
  std::vector<std::uint8_t> digest(std::size_t(bytes), 0);
  const bool made =
      PKCS5_PBKDF2_HMAC(text.data(), int(text.size()),
                        reinterpret_cast<const unsigned char*>(salt.data()), int(salt.size()),
                        iterations, EVP_sha256(), bytes, digest.data()) == 1;
  return made ? hexOf(digest) : std::string();
}

bool sameSecret(std::string_view a, std::string_view b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

Result<std::string> randomHex(int bytes) {
  std::vector<std::uint8_t> random(std::size_t(bytes), 0);
  if (RAND_bytes(random.data(), bytes) != 1) {
    return Error{"NO_RANDOM_NUMBERS", "The system gives no random numbers", "", "Try again"};
  }
  return hexOf(random);
}

}  // namespace trephine
