// A short secret that a person types, kept as a salted hash: PBKDF2 with HMAC-SHA-256.
#pragma once

#include <string>
#include <string_view>

#include "base/json.h"
#include "base/result.h"

namespace trephine {

constexpr std::size_t kLeastOfPin = 4, kMostOfPin = 12;  // digits and letters from A to Z

struct Pin {
  int iterations = 0;
  std::string salt_hex, hash_hex;
};

// With a fresh salt. Errors: BAD_PIN for what is too short, too long or has other characters,
// NO_RANDOM_NUMBERS where the system gives none. Takes as long as pinMatches.
Result<Pin> makePin(std::string_view text);

// Takes some tenths of a second, so that trying all of them takes long: not for a thread that
// draws. How much of the text is right does not show in the time. A small letter is another than
// its capital. False for a Pin that holds none.
bool pinMatches(const Pin& pin, std::string_view text);

// {algorithm: "pbkdf2-sha256", iterations, salt_hex, hash_hex}. What is wrong with it is the
// reader's error: finish() of the first reader gives it.
Pin readPin(JsonReader pin);
Json toJson(const Pin& pin);

}  // namespace trephine
