#include "ui/cases/report_card.h"

#include <QGridLayout>

#include "ui/cases/import_words.h"
#include "ui/cases/state_mark.h"
#include "ui/common/colours.h"
#include "ui/common/making.h"

namespace trephine {

namespace {
constexpr int kCardMark = 28;
}

ReportCard::ReportCard(QWidget* questions, QWidget* parent) : QWidget(parent) {
  mark_ = new QLabel(this);
  word_ = new QLabel(this);
  word_->setObjectName("verdictWord");
  QFont large = font();
  large.setPointSizeF(large.pointSizeF() * 1.3);
  large.setBold(true);
  word_->setFont(large);
  sentence_ = new QLabel(this);
  sentence_->setObjectName("verdictSentence");
  report_ = new QLabel(this);
  report_->setObjectName("reportCard");
  report_->setTextFormat(Qt::RichText);
  memory_ = new QLabel(this);
  memory_->setObjectName("memoryNeeded");
  for (QLabel* label : {sentence_, memory_}) label->setTextFormat(Qt::PlainText);
  for (QLabel* label : {sentence_, report_, memory_}) {
    label->setWordWrap(true);
    label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  }

  auto* layout = tight(new QGridLayout(this));
  layout->setColumnStretch(1, 1);
  layout->addWidget(mark_, 0, 0);
  layout->addWidget(word_, 0, 1);
  layout->addWidget(sentence_, 1, 0, 1, 2);
  if (questions) layout->addWidget(questions, 2, 0, 1, 2);
  layout->addWidget(report_, 3, 0, 1, 2);
  layout->addWidget(memory_, 4, 0, 1, 2);
}

void ReportCard::showSeries(const SeriesReport& series, const Answers& answers, double needed_mb,
                            double free_mb) {
  const SeriesState state = seriesState(series, answers);
  mark_->setPixmap(stateIcon(state).pixmap(QSize(kCardMark, kCardMark), devicePixelRatioF()));
  word_->setText(stateWord(state));
  sentence_->setText(verdictSentence(series, answers));
  report_->setText(reportHtml(series));
  memory_->setText(memoryWords(needed_mb, free_mb));
  memory_->setVisible(!memory_->text().isEmpty() && mayBeRead(state));
  const bool short_of = needed_mb >= free_mb;
  QPalette palette = this->palette();
  palette.setColor(QPalette::WindowText, short_of ? colours::kCaution : colours::kText);
  memory_->setPalette(palette);
}

}  // namespace trephine
