#include "tissue/tissue_numbers.h"

namespace trephine {

const SourcedNumber* TissueNumber::of(const SetNumbers& tissue) const {
  if (const auto* always = std::get_if<0>(&in_set)) return &(tissue.**always);
  const std::optional<SourcedNumber>& number = tissue.*std::get<1>(in_set);
  return number ? &*number : nullptr;
}

void TissueNumber::set(SetNumbers& tissue, const SourcedNumber& number) const {
  std::visit([&](auto member) { tissue.*member = number; }, in_set);
}

void TissueNumber::clear(SetNumbers& tissue) const {
  if (in_set.index() == 1) (tissue.*std::get<1>(in_set)).reset();
}

}  // namespace trephine
