#include "ui/common/pdf_page.h"

#include <QAbstractTextDocumentLayout>
#include <QBuffer>
#include <QPainter>
#include <QPdfWriter>
#include <QTextDocument>

namespace trephine {

namespace {

constexpr double kMargin_mm = 15.0;
constexpr int kDotsPerInch = 600;
constexpr double kSmallest = 0.6;

}  // namespace

QByteArray pdfOf(const QString& html) {
  QByteArray bytes;
  QBuffer buffer(&bytes);
  buffer.open(QIODevice::WriteOnly);
  QPdfWriter writer(&buffer);
  writer.setPageSize(QPageSize(QPageSize::A4));
  writer.setPageMargins(QMarginsF(kMargin_mm, kMargin_mm, kMargin_mm, kMargin_mm),
                        QPageLayout::Millimeter);
  writer.setResolution(kDotsPerInch);
  writer.setCreator("Trephine");

  QTextDocument text;
  text.documentLayout()->setPaintDevice(&writer);
  text.setDocumentMargin(0.0);
  text.setHtml(html);
  const QSizeF page(writer.width(), writer.height());
  double scale = 1.0;
  text.setPageSize(page);
  while (text.pageCount() > 1 && scale > kSmallest) {
    scale -= 0.05;
    text.setPageSize(page / scale);
  }

  QPainter painter(&writer);
  QAbstractTextDocumentLayout::PaintContext context;
  context.palette.setColor(QPalette::Text, Qt::black);  // the window's is light
  for (int n = 0; n < text.pageCount(); ++n) {
    if (n > 0) writer.newPage();
    painter.save();
    painter.scale(scale, scale);
    painter.translate(0.0, -n * text.pageSize().height());
    context.clip = QRectF(QPointF(0.0, n * text.pageSize().height()), text.pageSize());
    text.documentLayout()->draw(&painter, context);
    painter.restore();
  }
  painter.end();
  return bytes;
}

}  // namespace trephine
