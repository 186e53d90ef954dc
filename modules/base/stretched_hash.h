// Hashes of what a person could guess (a name, an ID, a PIN): slow on purpose, each with a salt, or
// by a key that nobody has.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"

namespace trephine {

// About 20 ms of one core of 2024; to be kept beside the hashes, so that it can grow.
constexpr int kStretchIterations = 50000;

// `bytes` of PBKDF2-HMAC-SHA256 as lower-case hexadecimal digits; the same for the same four.
// The salt is any bytes, at least one iteration is made. Empty where the hash cannot be had.
std::string stretchedHash(std::string_view text, std::string_view salt,
                          int iterations = kStretchIterations, int bytes = 16);

// HMAC-SHA256 of a text by a key, of any bytes each: its first 16 bytes as hexadecimal digits.
// Fast: the key is what cannot be guessed. Empty where it cannot be had.
std::string keyedHash(std::string_view text, std::string_view key);

// Whether two texts are the same; how much of them is does not show in the time.
bool sameSecret(std::string_view a, std::string_view b);

// That many bytes nobody can foresee, as hexadecimal digits. Error: NO_RANDOM_NUMBERS.
Result<std::string> randomHex(int bytes);

}  // namespace trephine
