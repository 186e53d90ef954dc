// Fits structures where nobody is there to be asked.
#pragma once

#include "imaging/segmentation/structure_fit.h"

namespace trephine::test {

inline Result<StructureFit> fitted(const Segmentation& of, const Volume& ct,
                                   const Answers& answers = {}, bool ask_all = true) {
  return fitOf(fitStructures(of, ct, answers, ask_all));
}

}  // namespace trephine::test
