#include "ui/cases/choice_panel.h"

#include <QButtonGroup>
#include <QFrame>
#include <QGridLayout>
#include <QLabel>
#include <QRadioButton>
#include <QVBoxLayout>

#include "ui/common/making.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr int kOptionPicture = 72;

// A radio button whose words may take several lines: the words are a label that chooses it.
class OptionLabel : public QLabel {
 public:
  OptionLabel(const QString& text, QRadioButton* button) : QLabel(text), button_(button) {
    setWordWrap(true);
    setTextFormat(Qt::PlainText);
  }

 protected:
  void mouseReleaseEvent(QMouseEvent*) override {
    button_->setFocus();
    button_->click();
  }

 private:
  QRadioButton* button_;
};

}  // namespace

ChoicePanel::ChoicePanel(QWidget* parent) : QWidget(parent) {
  tight(new QVBoxLayout(this));
}

void ChoicePanel::ask(const std::vector<Choice>& choices, const Answers& answers) {
  while (QLayoutItem* item = layout()->takeAt(0)) {
    delete item->widget();
    delete item;
  }
  choices_ = choices;
  answers_.clear();
  pictures_.clear();
  for (const Choice& choice : choices_) {
    if (const auto known = answers.find(choice.code); known != answers.end()) {
      answers_.insert(*known);
    }
    addChoice(choice);
  }
  setVisible(!choices_.empty());
}

void ChoicePanel::addChoice(const Choice& choice) {
  auto* card = new QFrame(this);
  card->setProperty("card", true);
  auto* grid = new QGridLayout(card);
  grid->setColumnStretch(1, 1);
  auto* question = new QLabel(toQt(choice.question), card);
  question->setTextFormat(Qt::PlainText);
  question->setProperty("title", true);
  question->setWordWrap(true);
  grid->addWidget(question, 0, 0, 1, 3);

  auto* group = new QButtonGroup(card);
  for (std::size_t i = 0; i < choice.options.size(); ++i) {
    const std::string& option = choice.options[i];
    const QString words = toQt(i < choice.words.size() ? choice.words[i] : option);
    auto* button = new QRadioButton(card);
    button->setObjectName(toQt("choice_" + choice.code.str() + "_" + option));
    button->setAccessibleName(words);
    const auto known = answers_.find(choice.code);
    button->setChecked(known != answers_.end() && known->second == option);
    group->addButton(button);
    const int row = 2 * int(i) + 1;
    grid->addWidget(button, row, 0, Qt::AlignTop);
    grid->addWidget(new OptionLabel(words, button), row, 1, Qt::AlignTop);
    if (i < choice.on_screen.size() && !choice.on_screen[i].empty()) {
      auto* more = new OptionLabel(toQt(choice.on_screen[i]), button);
      more->setProperty("quiet", true);
      grid->addWidget(more, row + 1, 1, Qt::AlignTop);
    }
    if (i < choice.shown.size() && choice.shown[i] >= 0) {
      auto* picture = new OptionLabel({}, button);
      picture->setObjectName(toQt("picture_" + choice.code.str() + "_" + option));
      picture->setFixedSize(kOptionPicture, kOptionPicture);
      picture->setAlignment(Qt::AlignCenter);
      grid->addWidget(picture, row, 2, 2, 1, Qt::AlignTop);
      pictures_.emplace(choice.shown[i], picture);
    }
    connect(button, &QRadioButton::toggled, this, [this, code = choice.code, option](bool on) {
      if (!on) return;
      answers_[code] = option;
      emit answered();
    });
  }
  layout()->addWidget(card);
}

std::vector<int> ChoicePanel::slicesShown() const {
  std::vector<int> slices;
  for (const auto& [slice, label] : pictures_) slices.push_back(slice);
  return slices;
}

void ChoicePanel::setPicture(int slice, const QImage& picture) {
  if (picture.isNull()) return;
  const double ratio = devicePixelRatioF();
  QPixmap shown = QPixmap::fromImage(picture).scaled(QSize(kOptionPicture, kOptionPicture) * ratio,
                                                     Qt::KeepAspectRatio, Qt::SmoothTransformation);
  shown.setDevicePixelRatio(ratio);
  const auto [first, last] = pictures_.equal_range(slice);
  for (auto it = first; it != last; ++it) it->second->setPixmap(shown);
}

bool ChoicePanel::allAnswered() const {
  for (const Choice& choice : choices_) {
    if (!answers_.contains(choice.code)) return false;
  }
  return true;
}

}  // namespace trephine
