// Some tests look at as many clicks, poses or bytes as they are told: few in every run, all in the
// label slow, whose entries set TREPHINE_THOROUGH (trephine_thorough in tests/CMakeLists.txt).
#pragma once

#include <cstdlib>

namespace trephine::test {

template <class Number>
Number thoroughly(Number all, Number few) {
  const char* wanted = std::getenv("TREPHINE_THOROUGH");
  return wanted && *wanted ? all : few;
}

}  // namespace trephine::test
