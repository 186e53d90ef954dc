// A page of text as PDF.
#pragma once

#include <QByteArray>
#include <QString>

namespace trephine {

// A4; it is printed smaller, down to 60 %, before it takes a second page. Any thread, with a
// QGuiApplication.
QByteArray pdfOf(const QString& html);

}  // namespace trephine
