// What settings of scenes are called on the screen, and the line below each that says what it does.
#pragma once

#include <QLabel>
#include <QString>
#include <QWidget>

#include "base/number_row.h"

namespace trephine {

// "Motion scale" of "motion_scale", without the unit at its end.
QString nameOfSetting(const char* key);
// The row's meaning as sentences, with its range; and in one line.
QString meaningOf(const NumberRow& row);
QString shortMeaningOf(const NumberRow& row);
// A step of a field in that unit.
double stepOfUnit(const char* unit);
// A small quiet line below a field.
QLabel* settingHint(const QString& words, QWidget* parent);

}  // namespace trephine
