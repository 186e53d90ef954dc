#include "imaging/volume_steps.h"

namespace trephine {

Status takeVolumeSteps(const ImportRequest&, const Progress&, SeriesReport&, Volume&,
                       std::optional<MeasuredLoss>&) {
  return {};
}

}  // namespace trephine
