#include "ui/frame/help_page.h"

#include <QFileInfo>
#include <QHBoxLayout>
#include <QImage>
#include <QKeyEvent>
#include <QPushButton>
#include <QResizeEvent>
#include <QScrollBar>
#include <QShortcut>
#include <QVBoxLayout>

#include "base/system.h"
#include "ui/common/making.h"
#include "ui/common/placing.h"
#include "ui/common/preferences.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr QSize kHelpSize(860, 720);

QUrl pageUrl(const QString& page) {
  const QString folder = toQt((resourceFolder() / "help").string());
  const QString own = folder + '/' + toQt(languageInUse()) + '/' + page + ".md";
  return QUrl::fromLocalFile(QFileInfo::exists(own) ? own : folder + "/en/" + page + ".md");
}

}  // namespace

QVariant HelpText::loadResource(int type, const QUrl& name) {
  const QVariant read = QTextBrowser::loadResource(type, name);
  if (type != QTextDocument::ImageResource) return read;
  QImage picture;
  picture.loadFromData(read.toByteArray());
  const int room = viewport()->width() - 2 * int(document()->documentMargin());
  if (picture.isNull() || room <= 0) return read;
  const double dots = devicePixelRatioF();
  if (picture.width() > room * dots) {
    picture = picture.scaledToWidth(int(room * dots), Qt::SmoothTransformation);
  }
  if (picture.width() > room) picture.setDevicePixelRatio(picture.width() / double(room));
  return picture;
}

// Pictures are kept as they were loaded: a page that is wider or narrower has them anew.
void HelpText::resizeEvent(QResizeEvent* event) {
  QTextBrowser::resizeEvent(event);
  if (event->size().width() == event->oldSize().width() || source().isEmpty()) return;
  const int at = verticalScrollBar()->value();
  reload();
  verticalScrollBar()->setValue(at);
}

HelpPage::HelpPage(QWidget* parent) : QWidget(parent, Qt::Window) {
  setObjectName("helpPage");
  setAttribute(Qt::WA_DeleteOnClose);
  setWindowTitle(tr("Help"));
  text_ = named(new HelpText, "helpText");
  text_->setOpenExternalLinks(false);
  text_->setVerticalScrollBarPolicy(
      Qt::ScrollBarAlwaysOn);  // it takes no room from a picture later
  auto* contents = named(new QPushButton(tr("&Contents")), "helpContents");
  auto* back = new QPushButton(tr("&Back"));
  auto* close = new QPushButton(tr("C&lose"));
  auto* row = new QHBoxLayout;
  row->addWidget(contents);
  row->addWidget(back);
  row->addStretch(1);
  row->addWidget(close);
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(text_, 1);
  layout->addLayout(row);
  connect(contents, &QPushButton::clicked, this, [this] { open("index"); });
  connect(back, &QPushButton::clicked, text_, &QTextBrowser::backward);
  connect(close, &QPushButton::clicked, this, &QWidget::close);
  connect(text_, &QTextBrowser::backwardAvailable, back, &QWidget::setEnabled);
  back->setEnabled(false);
  resize(sizeOnScreen(kHelpSize, *parent));
}

void HelpPage::open(const QString& page) {
  text_->setSource(pageUrl(page), QTextDocument::MarkdownResource);
  text_->setFocus();
}

void HelpPage::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape) return void(close());
  QWidget::keyPressEvent(event);
}

void showHelp(QWidget* parent, const QString& page) {
  auto* help = parent->findChild<HelpPage*>(QString(), Qt::FindDirectChildrenOnly);
  if (!help) help = new HelpPage(parent);
  help->open(page);
  help->show();
  help->raise();
  help->activateWindow();
}

void helpByF1(QDialog* dialog, const QString& page) {
  QObject::connect(new QShortcut(QKeySequence(Qt::Key_F1), dialog), &QShortcut::activated, dialog,
                   [dialog, page] { showHelp(dialog, page); });
}

}  // namespace trephine
