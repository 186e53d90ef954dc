// Sentences that a person reads, in that person's language. A room (a folder of modules/) writes
// each as an English sentence, a literal, with a place for every argument; that is the key of its
// translation; the window's translation files hold them in the context "trephine". Any thread but
// the haptic one: it allocates.
#pragma once

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

namespace trephine {

// What stands in one place of a sentence: text as it is, a whole number in digits. How many digits
// another number has is for the caller to say (base/formatted.h).
class TrArg {
 public:
  TrArg(const std::string& text) : text_(text) {}
  TrArg(std::string_view text) : text_(text) {}
  TrArg(const char* text) : text_(text) {}
  template <std::integral Number>
  requires(!std::same_as<Number, bool> && !std::same_as<Number, char>) TrArg(Number number)
      : text_(std::to_string(number)) {}

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// `source` in the language that was set, with the arguments in their places: {} one after another,
// or {0}, {1} by number, since another language may want another order. {{ and }} stand for braces.
// A translation in which a place has no argument or a brace stands alone is not used; English of
// which that is so is shown as it stands, braces and all. An argument without a place is left out.
std::string trWith(const char* source, std::initializer_list<TrArg> args);

template <class... Args>
std::string tr(const char* source, const Args&... args) {
  return trWith(source, {TrArg(args)...});
}

// The same for a sentence that says a number of things: `one` where `count` is 1, else `many`,
// which is the key of the translation in all its forms. The count is {0}, the first of trCount()'s
// `args` is {1}; {} counts from the count on.
std::string trCountWith(std::uint64_t count, const char* one, const char* many,
                        std::initializer_list<TrArg> args);

template <class... Args>
std::string trCount(std::uint64_t count, const char* one, const char* many, const Args&... args) {
  return trCountWith(count, one, many, {TrArg(count), TrArg(args)...});
}

// Marks a sentence of a table for translation; who shows it calls tr().
constexpr const char* trLater(const char* source) {
  return source;
}

// Gives the translation of a source sentence (of trCount(): of `many`), or the sentence itself; in
// its form for `count` things. Above 1,000,000 `count` is 1,000,000 and the number's last six
// digits, by which forms go.
using Translator = std::string (*)(const char* source, std::optional<int> count);

// Called once, before other threads begin; English holds until then.
void setTranslator(Translator translator);

}  // namespace trephine
