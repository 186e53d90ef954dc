#include "base/pin.h"

#include <algorithm>
#include <cstdint>

#include "base/codes.h"
#include "base/hex.h"
#include "base/stretched_hash.h"
#include "base/tr.h"

namespace trephine {

namespace {

constexpr const char* kAlgorithm = "pbkdf2-sha256";
// What OWASP advises for this hash (Password Storage Cheat Sheet, 2023).
constexpr int kIterations = 600'000;
// Of a file: the work that a person waits for has an end.
constexpr Range kIterationRange{10'000, 10'000'000};
constexpr int kSaltBytes = 16, kHashBytes = 32, kMostSaltBytes = 64;

bool mayBePin(std::string_view text) {
  const auto allowed = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  };
  return text.size() >= kLeastOfPin && text.size() <= kMostOfPin &&
         std::ranges::all_of(text, allowed);
}

// Zero for what is no hex.
int bytesIn(const std::string& hex) {
  const auto bytes = bytesOfHex(hex);
  return bytes ? int(bytes->size()) : 0;
}

// Empty for what is no salt.
std::string hashOf(std::string_view text, const std::string& salt_hex, int iterations) {
  const auto salt = bytesOfHex(salt_hex);
  if (!salt || salt->empty()) return {};
  return stretchedHash(text, {reinterpret_cast<const char*>(salt->data()), salt->size()},
                       iterations, kHashBytes);
}

}  // namespace

Result<Pin> makePin(std::string_view text) {
  if (!mayBePin(text)) {
    return Error{code::kBadPin,
                 tr("A PIN has 4 to 12 digits or letters from A to Z, and nothing else"), "",
                 tr("Choose another")};
  }
  const Result<std::string> salt = randomHex(kSaltBytes);
  if (!salt) return salt.error();
  return Pin{kIterations, *salt, hashOf(text, *salt, kIterations)};
}

bool pinMatches(const Pin& pin, std::string_view text) {
  const auto wanted = bytesOfHex(pin.hash_hex);
  if (!mayBePin(text) || !wanted || int(wanted->size()) != kHashBytes ||
      !kIterationRange.holds(pin.iterations)) {
    return false;
  }
  return sameSecret(hashOf(text, pin.salt_hex, pin.iterations), hexOf(*wanted));
}

Pin readPin(JsonReader reader) {
  Pin pin;
  if (const std::string name = reader.text("algorithm"); reader.ok() && name != kAlgorithm) {
    reader.fail("algorithm", tr("Unknown algorithm '{}'", name),
                tr("Use {}, as trephine-lab pin does", kAlgorithm));
  }
  pin.iterations = int(reader.integer("iterations", kIterationRange));
  pin.salt_hex = reader.text("salt_hex");
  pin.hash_hex = reader.text("hash_hex");
  if (!reader.ok()) return pin;
  const int salt = bytesIn(pin.salt_hex);
  if (salt < kSaltBytes || salt > kMostSaltBytes) {
    reader.fail("salt_hex", tr("The salt is not 32 to 128 digits of hex"),
                tr("Copy it as trephine-lab pin printed it"));
  }
  if (bytesIn(pin.hash_hex) != kHashBytes) {
    reader.fail("hash_hex", tr("The hash is not 64 digits of hex"),
                tr("Copy it as trephine-lab pin printed it"));
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
