// The tools that need nothing but a slice. Their parent deletes them.
#pragma once

#include "ui/views/slice_measure.h"
#include "ui/views/view_tool.h"

namespace trephine {

// The HU window by dragging: right is wider, up is brighter.
ViewTool* windowTool(QObject* parent);
// The point that all slices share, by click or drag.
ViewTool* pointTool(QObject* parent);
// The ruler, from end to end by a drag or two clicks; the angle, by clicks: an end, the corner, the
// other end.
ViewTool* measureTool(Measure::Kind kind, QObject* parent);

}  // namespace trephine
