// The window's dark theme: calm greys beside the picture, colour only where it means something.
#pragma once

#include <QApplication>
#include <QColor>
#include <QLabel>

namespace trephine::colours {

inline const QColor kWindow(0x23, 0x25, 0x29);
inline const QColor kPanel(0x1b, 0x1d, 0x20);
inline const QColor kRaised(0x32, 0x35, 0x3b);
inline const QColor kLine(0x43, 0x47, 0x4f);
inline const QColor kText(0xe4, 0xe6, 0xea);
inline const QColor kQuiet(0xa2, 0xa8, 0xb2);
inline const QColor kAccent(0x3d, 0x8f, 0xd6);
inline const QColor kGood(0x4f, 0xb3, 0x77);
inline const QColor kCaution(0xe0, 0xa5, 0x3a);
inline const QColor kBad(0xe0, 0x62, 0x5a);
inline const QColor kLeftArm(0x55, 0xb9, 0xd6);
inline const QColor kRightArm(0xee, 0xa2, 0x4b);

// Fusion style, palette and a few style rules.
void applyTheme(QApplication& application);

void setText(QLabel& label, const QColor& colour);

}  // namespace trephine::colours
