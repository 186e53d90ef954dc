#include "device/arm_numbers.h"

#include <cstring>
#include <string_view>

#include "base/tr.h"

namespace trephine {

double CapabilityNumber::value(const TrephineCapabilities& of, std::size_t index) const {
  double value = 0.0;
  std::memcpy(&value, reinterpret_cast<const char*>(&of) + offset + index * sizeof(double),
              sizeof(double));
  return value;
}

std::string impossibleCapability(const TrephineCapabilities& capabilities) {
  const std::uint32_t dof = capabilities.input_dof;
  if (dof != 0 && dof != 3 && dof != 6) {
    return tr("'input_dof' of {}, which must be 0, 3 or 6", dof);
  }
  for (const CapabilityNumber& number : kCapabilityNumbers) {
    if (dof == 0 && std::string_view(number.row.key) != "rate_hz") continue;
    for (std::size_t i = 0; i < number.count; ++i) {
      const double value = number.value(capabilities, i);
      if (number.row.range.holds(value)) continue;
      return tr("'{}' of {}, which must lie {}", number.row.key, plainNumber(value),
                number.row.range.words());
    }
  }
  return {};
}

std::string capabilityPage() {
  std::string page = schemaHead();
  for (const CapabilityNumber& number : kCapabilityNumbers) {
    page += schemaLine("arm", number.row, number.count == 3 ? "three numbers" : "number", "");
  }
  return page;
}

}  // namespace trephine
