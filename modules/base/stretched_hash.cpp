#include "base/stretched_hash.h"

#include <openssl/evp.h>
#include <openssl/rand.h>

#include <array>
#include <span>
#include <vector>

namespace trephine {

namespace {

std::string hexOf(std::span<const unsigned char> bytes) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

}  // namespace

std::string stretchedHash(std::string_view text, std::string_view salt, int iterations) {
  std::array<unsigned char, 16> digest{};
  PKCS5_PBKDF2_HMAC(text.data(), int(text.size()),
                    reinterpret_cast<const unsigned char*>(salt.data()), int(salt.size()),
                    iterations, EVP_sha256(), int(digest.size()), digest.data());
  return hexOf(digest);
}

Result<std::string> randomHex(int bytes) {
  std::vector<unsigned char> random(std::size_t(bytes), 0);
  if (RAND_bytes(random.data(), bytes) != 1) {
    return Error{"NO_RANDOM", "The system gives no random numbers", "", "Restart the computer"};
  }
  return hexOf(random);
}

}  // namespace trephine
