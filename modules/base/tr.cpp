#include "base/tr.h"

#include <charconv>
#include <optional>
#include <span>

namespace trephine {

namespace {

Translator installed = nullptr;

// Nothing where a place has no argument or a brace stands alone.
std::optional<std::string> filled(std::string_view words, std::span<const TrArg> args) {
  std::string text;
  text.reserve(words.size() + 16 * args.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const char c = words[i];
    if (c != '{' && c != '}') {
      text += c;
      continue;
    }
    if (i + 1 < words.size() && words[i + 1] == c) {
      text += c;
      ++i;
      continue;
    }
    const std::size_t end = c == '{' ? words.find('}', i) : std::string_view::npos;
    if (end == std::string_view::npos) return {};
    std::size_t place = next;
    if (end == i + 1) {
      ++next;
    } else {
      const char* const last = words.data() + end;
      const auto read = std::from_chars(words.data() + i + 1, last, place);
      if (read.ec != std::errc() || read.ptr != last) return {};
    }
    if (place >= args.size()) return {};
    text += args[place].text();
    i = end;
  }
  return text;
}

// The translation of `key`, in its form for `count` things; `english` where there is none whose
// places are those of the arguments.
std::string said(const char* key, std::optional<int> count, const char* english,
                 std::initializer_list<TrArg> args) {
  const std::span<const TrArg> given(args.begin(), args.size());
  if (installed) {
    const std::string translated = installed(key, count);
    std::optional<std::string> text;
    if (translated != key) text = filled(translated, given);
    if (text) return *text;
  }
  return filled(english, given).value_or(english);
}

}  // namespace

std::string trWith(const char* source, std::initializer_list<TrArg> args) {
  return said(source, {}, source, args);
}

std::string trCountWith(std::uint64_t count, const char* one, const char* many,
                        std::initializer_list<TrArg> args) {
  // Forms follow the last digits.
  const int digits = count <= 1'000'000 ? int(count) : int(1'000'000 + count % 1'000'000);
  return said(many, digits, count == 1 ? one : many, args);
}

void setTranslator(Translator translator) {
  installed = translator;
}

}  // namespace trephine
