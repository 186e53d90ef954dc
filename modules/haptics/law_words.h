// What a law says of itself, in its own file: how it is called, what it does and which numbers of a
// tissue it uses.
#pragma once

namespace trephine {

struct LawWords {
  const char* id;       // in exercises and recordings; stable
  const char* name;     // shown
  const char* meaning;  // shown: a sentence
};

}  // namespace trephine
