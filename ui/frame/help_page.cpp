#include "ui/frame/help_page.h"

#include <QFileInfo>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QPushButton>
#include <QVBoxLayout>

#include "base/system.h"
#include "ui/common/placing.h"
#include "ui/common/settings.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr QSize kHelpSize(860, 720);

QUrl pageUrl(const QString& page) {
  const QString folder = toQt((resourceFolder() / "help").string());
  const QString own = folder + '/' + read(settings::kLanguage) + '/' + page + ".md";
  return QUrl::fromLocalFile(QFileInfo::exists(own) ? own : folder + "/en/" + page + ".md");
}

}  // namespace

HelpPage::HelpPage(QWidget* parent) : QWidget(parent, Qt::Window) {
  setObjectName("helpPage");
  setAttribute(Qt::WA_DeleteOnClose);
  setWindowTitle(tr("Help"));
  text_ = new QTextBrowser;
  text_->setObjectName("helpText");
  text_->setOpenExternalLinks(false);
  auto* contents = new QPushButton(tr("&Contents"));
  contents->setObjectName("helpContents");
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

}  // namespace trephine
