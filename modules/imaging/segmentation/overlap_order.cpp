#include "imaging/segmentation/overlap_order.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>

#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/common/detail/text.h"

namespace trephine {

namespace {

// As merged() calls one without a name.
std::string nameOf(const Segmentation::Segment& segment) {
  return segment.name.empty() ? "label " + std::to_string(segment.value) : segment.name;
}

std::vector<std::string> parted(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

}  // namespace

std::string orderAnswer(const std::vector<std::string>& names) {
  std::string answer = kOrderAnswer;
  for (std::size_t n = 0; n < names.size(); ++n) answer += (n > 0 ? "," : "") + names[n];
  return answer;
}

Result<std::vector<std::size_t>> orderFrom(const std::string& answer, const Segmentation& of) {
  const std::vector<std::string> parts = parted(answer.substr(std::string(kOrderAnswer).size()));
  std::vector<std::size_t> order;
  std::vector<bool> taken(of.segments.size());
  const auto find = [&](const std::string& name) -> std::optional<std::size_t> {
    for (std::size_t s = 0; s < of.segments.size(); ++s) {
      if (!taken[s] && sameName(nameOf(of.segments[s]), name)) return s;
    }
    return {};
  };
  for (std::size_t first = 0; first < parts.size();) {
    // The longest run of parts that is a name: names may hold commas.
    std::optional<std::size_t> found;
    std::size_t next = first + 1;
    for (std::size_t end = parts.size(); end > first && !found; --end) {
      std::string name = parts[first];
      for (std::size_t p = first + 1; p < end; ++p) name += "," + parts[p];
      found = find(name);
      next = end;
    }
    if (!found) {
      std::vector<std::string> names;
      for (const auto& segment : of.segments) names.push_back("'" + nameOf(segment) + "'");
      return Error{code::kBadChoice,
                   tr("The order for OVERLAP names '{}', which is no structure of the file or "
                      "stands there already",
                      cleanUtf8(parts[first])),
                   "", tr("Choose among {}, each once", listed(names))};
    }
    taken[*found] = true;
    order.push_back(*found);
    first = next;
  }
  for (const std::size_t s : smallerFirst(of)) {
    if (!taken[s]) order.push_back(s);
  }
  return order;
}

std::vector<std::string> overlapping(const Segmentation& of, const std::vector<Overlap>& shared,
                                     const std::vector<std::size_t>& order) {
  std::set<std::size_t> sharing;
  for (const Overlap& pair : shared) sharing.insert({pair.a, pair.b});
  std::vector<std::string> names;
  for (const std::size_t s : order) {
    if (sharing.contains(s)) names.push_back(nameOf(of.segments[s]));
  }
  return names;
}

}  // namespace trephine
