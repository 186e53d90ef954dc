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

}  // namespace

std::string trWith(const char* source, std::initializer_list<TrArg> args) {
  const std::span<const TrArg> given(args.begin(), args.size());
  if (installed) {
    if (std::optional<std::string> text = filled(installed(source, {}), given)) return *text;
  }
  return filled(source, given).value_or(source);
}

std::string trCountWith(std::uint64_t count, const char* one, const char* many,
                        std::initializer_list<TrArg> args) {
  const std::span<const TrArg> given(args.begin(), args.size());
  if (installed) {
    // Forms follow the last digits.
    const int digits = count <= 1'000'000 ? int(count) : int(1'000'000 + count % 1'000'000);
    const std::string translated = installed(many, digits);
    if (translated != many) {
      if (std::optional<std::string> text = filled(translated, given)) return *text;
    }
  }
  const char* const source = count == 1 ? one : many;
  return filled(source, given).value_or(source);
}

void setTranslator(Translator translator) {
  installed = translator;
}

}  // namespace trephine
