#include "tissue/tissue_numbers.h"

namespace trephine {

const SourcedNumber* TissueNumber::of(const SetNumbers& tissue) const {
  if (const auto* always = std::get_if<0>(&in_set)) return &(tissue.**always);
  const std::optional<SourcedNumber>& number = tissue.*std::get<1>(in_set);
  return number ? &*number : nullptr;
}

void TissueNumber::set(SetNumbers& tissue, const SourcedNumber& number) const {
  std::visit([&](auto member) { tissue.*member = number; }, in_set);
  if (in_tick == &TickNumbers::cutting_J_per_mm3) tissue.toughness_J_per_m2.reset();
  if (in_tick == &TickNumbers::toughness_J_per_m2) tissue.cutting_J_per_mm3.reset();
}

void TissueNumber::clear(SetNumbers& tissue) const {
  if (isCutting()) return;
  if (in_set.index() == 1) (tissue.*std::get<1>(in_set)).reset();
}

}  // namespace trephine
