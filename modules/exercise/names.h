// Names of kinds in files, from one table each.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/tr.h"

namespace trephine {

template <class Kind, std::size_t N>
using Names = std::array<std::pair<std::string_view, Kind>, N>;

template <class Kind, std::size_t N>
std::string nameOf(const Names<Kind, N>& names, Kind kind) {
  for (const auto& [name, k] : names) {
    if (k == kind) return std::string(name);
  }
  return {};
}

template <class Kind, std::size_t N>
std::optional<Kind> kindOf(const Names<Kind, N>& names, const std::string& text) {
  for (const auto& [name, k] : names) {
    if (name == text) return k;
  }
  return {};
}

template <class Kind, std::size_t N>
std::string choices(const Names<Kind, N>& names) {
  std::string text;
  for (const auto& [name, kind] : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return tr("Use one of: {}", text);
}

}  // namespace trephine
