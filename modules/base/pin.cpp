#include "base/pin.h"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/rand.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace trephine {

namespace {

constexpr const char* kAlgorithm = "pbkdf2-sha256";
// What OWASP advises for this hash (Password Storage Cheat Sheet, 2023).
constexpr int kIterations = 600'000;
// Of a file: the work that a person waits for has an end.
constexpr Range kIterationRange{10'000, 10'000'000};
constexpr std::size_t kSaltBytes = 16, kHashBytes = 32, kMostSaltBytes = 64;

using Bytes = std::vector<std::uint8_t>;
using Hash = std::array<std::uint8_t, kHashBytes>;

std::string hexOf(const std::uint8_t* bytes, std::size_t count) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    text += kDigits[bytes[i] >> 4];
    text += kDigits[bytes[i] & 15];
  }
  return text;
}

// Empty for what is no hex.
Bytes bytesOf(std::string_view hex) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
  };
  Bytes bytes;
  if (hex.size() % 2 != 0) return {};
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    const int high = digit(hex[i]), low = digit(hex[i + 1]);
    if (high < 0 || low < 0) return {};
    bytes.push_back(std::uint8_t(16 * high + low));
  }
  return bytes;
}

bool mayBePin(std::string_view text) {
  const auto allowed = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  };
  return text.size() >= kLeastOfPin && text.size() <= kMostOfPin &&
         std::ranges::all_of(text, allowed);
}

bool hashOf(std::string_view text, const Bytes& salt, int iterations, Hash& hash) {
  return PKCS5_PBKDF2_HMAC(text.data(), int(text.size()), salt.data(), int(salt.size()), iterations,
                           EVP_sha256(), int(hash.size()), hash.data()) == 1;
}

}  // namespace

Result<Pin> makePin(std::string_view text) {
  if (!mayBePin(text)) {
    return Error{"BAD_PIN", "A PIN has 4 to 12 digits or letters from A to Z, and nothing else", "",
                 "Choose another"};
  }
  Bytes salt(kSaltBytes);
  Hash hash{};
  if (RAND_bytes(salt.data(), int(salt.size())) != 1 || !hashOf(text, salt, kIterations, hash)) {
    return Error{"NO_RANDOM_NUMBERS", "The system gave no random numbers to keep the PIN with", "",
                 "Try again"};
  }
  return Pin{kIterations, hexOf(salt.data(), salt.size()), hexOf(hash.data(), hash.size())};
}

bool pinMatches(const Pin& pin, std::string_view text) {
  const Bytes wanted = bytesOf(pin.hash_hex), salt = bytesOf(pin.salt_hex);
  Hash hash{};
  if (!mayBePin(text) || wanted.size() != hash.size() || salt.empty() ||
      !kIterationRange.holds(pin.iterations) || !hashOf(text, salt, pin.iterations, hash)) {
    return false;
  }
  return CRYPTO_memcmp(hash.data(), wanted.data(), hash.size()) == 0;
}

Pin readPin(JsonReader reader) {
  Pin pin;
  if (const std::string name = reader.text("algorithm"); reader.ok() && name != kAlgorithm) {
    reader.fail("algorithm", "Unknown algorithm '" + name + "'",
                std::string("Use ") + kAlgorithm + ", as trephine-lab pin does");
  }
  pin.iterations = int(reader.integer("iterations", kIterationRange));
  pin.salt_hex = reader.text("salt_hex");
  pin.hash_hex = reader.text("hash_hex");
  if (!reader.ok()) return pin;
  const std::size_t salt = bytesOf(pin.salt_hex).size();
  if (salt < kSaltBytes || salt > kMostSaltBytes) {
    reader.fail("salt_hex", "The salt is not 32 to 128 digits of hex",
                "Copy it as trephine-lab pin printed it");
  }
  if (bytesOf(pin.hash_hex).size() != kHashBytes) {
    reader.fail("hash_hex", "The hash is not 64 digits of hex",
                "Copy it as trephine-lab pin printed it");
  }
  return pin;
}

Json toJson(const Pin& pin) {
  return {{"algorithm", kAlgorithm},
          {"iterations", pin.iterations},
          {"salt_hex", pin.salt_hex},
          {"hash_hex", pin.hash_hex}};
}

}  // namespace trephine
