// Forms of settings: what these are called on the screen, the line below each that says what it
// does, and how a refusal is said.
#pragma once

#include <QComboBox>
#include <QFormLayout>
#include <QLabel>
#include <QString>
#include <QToolButton>
#include <QWidget>

#include "base/field.h"
#include "base/result.h"

namespace trephine {

// The row's meaning as sentences, with its range; and in one line.
QString meaningOf(const FieldRow& row);
QString shortMeaningOf(const FieldRow& row);
// A step of a field in that unit.
double stepOfUnit(const char* unit);
// A small quiet line below a field.
QLabel* settingHint(const QString& words, QWidget* parent);
// What a setting is that no field could hold.
QLabel* settingText(const char* name, QWidget* parent);
// A field, and below it what it does.
QWidget* withHint(QWidget* field, const QString& words, QWidget* parent);

// What is wrong, beside what it is of; hidden until there is something to say.
QLabel* problemLabel(const char* name, QWidget* parent);
// "Not applied.", why, and what to do.
void sayNotApplied(QLabel& problem, const Error& why);

// Of a narrow column.
QFormLayout* settingForm(QWidget* of);
QComboBox* settingChoice(const char* name, const QString& accessible, QWidget* parent);
QToolButton* settingButton(const char* name, const QString& text, const QString& tip,
                           QWidget* parent);
QLabel* settingTitle(const QString& words, QWidget* parent);

}  // namespace trephine
