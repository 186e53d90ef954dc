// What a CT shows: a head, an abdomen, or not to be told. By its voxels alone, on a grid of a few
// millimetres; body-part tags are often wrong. Pure.
//
// A head is a cavity of a hand's width with bone all around it, as seen in slices of one of three
// directions, so that one that is cut through or turned is still one. An abdomen is a body that is
// wide, has little bone, and holds a piece of tissue of an organ's HU into which a ball of 5 cm
// goes and which is no head.
#pragma once

#include <string>

#include "base/progress.h"
#include "volume/volume.h"

namespace trephine {

enum class BodyRegion { not_sure, head, abdomen };
const char* bodyRegionName(BodyRegion part);  // "not sure", "head", "abdomen"

struct Anatomy {
  BodyRegion region = BodyRegion::not_sure;
  // Of a head: bone closes it towards the crown within the scan, so that there is a vault to open.
  bool vault = false;

  // What was measured.
  double body_ml = 0.0;       // the largest piece above -300 HU
  double bone_percent = 0.0;  // of it
  double cavity_mm = 0.0;     // of slices in a row with a cavity, in the direction with most
  double cavity_ml = 0.0;     // in those
  double organ_ml = 0.0;      // of the largest piece of organ tissue
  double width_mm = 0.0;      // of the body, the second of its three extents
};

// Two threads; a few bytes for each 4 mm cube beside the volume. Not told (not_sure) where it is
// cancelled.
Anatomy anatomyOf(const Volume& volume, const Progress& progress = Progress());

}  // namespace trephine
