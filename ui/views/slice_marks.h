// What lies over a slice: where the other views' slices cut it, tools, measures, where arms reach,
// words at its edges. Pure: what is given, by a painter.
#pragma once

#include <QColor>
#include <QPainter>
#include <QRectF>
#include <vector>

#include "render/scene_renderer.h"
#include "ui/views/slice_image.h"
#include "ui/views/slice_measure.h"
#include "ui/views/workspace_box.h"

namespace trephine {

// Slice `slice` of a stack, as it is shown in a widget of that size.
struct ShownSlice {
  SliceAxis axis = SliceAxis::axial;
  GridGeometry stack;
  int slice = 0;
  QRectF target;  // where all of it is drawn
  QSize widget;

  // Places of the patient in the widget, along the slice's normal, and how far along that they are:
  // not below 0.
  QPointF at(const Vec3& patient_mm) const;
  double off_mm(const Vec3& patient_mm) const;
  bool holds(const Measure& measure) const;
};

// "Axial", and "19.0 mm" or "30.5°".
QString nameOf(SliceAxis axis);
QString valueOf(const Measure& measure);
// Of a view's name, and of its slices as lines in the other two.
QColor colourOf(SliceAxis axis);

// Where the other two views' slices cut this one; open around the common point.
void paintCross(QPainter& painter, const ShownSlice& on, const Vec3& point_mm);
void paintTools(QPainter& painter, const ShownSlice& on, const std::vector<ToolView>& tools);
QRect toolsRect(const ShownSlice& on, const std::vector<ToolView>& tools);  // what those cover
// How far a place of the widget is from a measure's line or ends, in pixels.
double pixelsFrom(const ShownSlice& on, const Measure& measure, const QPointF& at);
void paintMeasure(QPainter& painter, const ShownSlice& on, const Measure& measure);
void paintWorkspaces(QPainter& painter, const ShownSlice& on,
                     const std::vector<WorkspaceBox>& boxes);
// The chosen one, where the place of the widget is near its middle or an edge; else null.
const WorkspaceBox* workspaceAt(const QPointF& place, const ShownSlice& on,
                                const std::vector<WorkspaceBox>& boxes);
// Which slice it is and how it is looked at, and below `readout`, as much of it as has room.
void paintFacts(QPainter& painter, const ShownSlice& on, const HuWindow& window,
                const QString& readout);

}  // namespace trephine
