// The window's theme, dark or light: calm greys beside the picture, colour only where it means
// something.
#pragma once

#include <QApplication>
#include <QColor>
#include <QLabel>

#include "base/math.h"

namespace trephine {
struct ExerciseArm;
}

namespace trephine::colours {

// Of the theme that was applied; the dark one until then.
inline QColor kWindow(0x23, 0x25, 0x29);
inline QColor kPanel(0x1b, 0x1d, 0x20);
inline QColor kRaised(0x32, 0x35, 0x3b);
inline QColor kLine(0x43, 0x47, 0x4f);
inline QColor kText(0xe4, 0xe6, 0xea);
inline QColor kQuiet(0xa2, 0xa8, 0xb2);
inline QColor kAccent(0x3d, 0x8f, 0xd6);
inline QColor kGood(0x4f, 0xb3, 0x77);
inline QColor kCaution(0xe0, 0xa5, 0x3a);
inline QColor kBad(0xe0, 0x62, 0x5a);
inline QColor kLeftArm(0x55, 0xb9, 0xd6);
inline QColor kRightArm(0xee, 0xa2, 0x4b);

// Voxels that a threshold takes and leaves while it is moved, in either theme.
inline const QColor kGained(0xff, 0xd9, 0x40);
inline const QColor kLost(0x59, 0xa6, 0xff);

// Of words over a picture, which is dark in either theme.
inline const QColor kOnPicture(0xe4, 0xe6, 0xea);

enum class Theme { dark, light };

// Fusion style, palette and a few style rules; text so many per cent of its usual size, and plain
// (PlainText). Before the first widget.
void applyTheme(QApplication& application, Theme theme = Theme::dark, int text_percent = 100);

// In which an arm's tool, box and card are drawn; `index`: among the exercise's.
QColor ofArm(const ExerciseArm& arm, std::size_t index);

// A tissue's or structure's colour, each part from 0 to 1, and back.
QColor of(const Vec3& rgb);
Vec3 rgbOf(const QColor& colour);

void setText(QLabel& label, const QColor& colour);

}  // namespace trephine::colours
