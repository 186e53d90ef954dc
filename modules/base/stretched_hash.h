// Hashes of what a person could guess (a name, an ID, a PIN): slow on purpose, each with a salt.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"

namespace trephine {

// About 20 ms of one core of 2024; to be kept beside the hashes, so that it can grow.
constexpr int kStretchIterations = 50000;

// PBKDF2-HMAC-SHA256 as 32 lower-case hexadecimal digits; the same for the same three.
std::string stretchedHash(std::string_view text, std::string_view salt,
                          int iterations = kStretchIterations);

// That many bytes nobody can foresee, as hexadecimal digits. Error: NO_RANDOM.
Result<std::string> randomHex(int bytes);

}  // namespace trephine
