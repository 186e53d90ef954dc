// What a trainee in a headset reads: drawn here, placed in the room by who shows it. Letters are so high
// that a headset of 15 pixels a degree shows them.
#pragma once

#include <QImage>
#include <QString>
#include <string>
#include <vector>

namespace trephine {

// How far to the right of what is looked at, and above it, and how wide.
struct EyeCard {
  std::string name;
  QImage image;
  double right_deg = 0.0, up_deg = 0.0, width_m = 0.3;
  bool before_all = false;  // where the patient would hide it
};

// A card's pixels stand for so many a degree, seen from where it is read.
constexpr double kCardDistance_m = 0.9;
constexpr double kPixelsPerDegree = 30.0;
// The height of small letters such as x, in degrees: 9 pixels of a headset of 15 a degree.
constexpr double kLetters_deg = 0.6;

struct HandForce {
  QString name;
  QColor colour;
  double sent_N = 0.0, demanded_N = 0.0, limit_N = 1.0;
  QString why;  // it is without force; empty: it has it
};

EyeCard forceCard(const std::vector<HandForce>& hands);
// The exercise's name and its time, and what it asks for.
EyeCard exerciseCard(const QString& title, const QString& time, const QString& goal);
// What else is to be known, below what is looked at.
EyeCard noteCard(const QString& words);
// A place in the room to be touched: its number beside a cross.
EyeCard markCard(int number);

}  // namespace trephine
