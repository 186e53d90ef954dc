#include "ui/cases/cases_page.h"

#include <QEvent>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QInputDialog>
#include <QKeyEvent>
#include <QPainter>
#include <QVBoxLayout>
#include <algorithm>
#include <iterator>
#include <utility>

#include "ui/common/colours.h"
#include "ui/common/icons.h"
#include "ui/common/making.h"
#include "ui/common/placing.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr QSize kCardPicture(192, 144);
constexpr QSize kCard(208, 222);
constexpr int kDetailsWidth = 280;
constexpr int kIdRole = Qt::UserRole;

// A case without one: a frame with its initial, so that the card is not a hole.
QPixmap cardPicture(const CaseEntry& entry) {
  if (!entry.picture.isNull()) {
    return QPixmap::fromImage(
        entry.picture.scaled(kCardPicture, Qt::KeepAspectRatio, Qt::SmoothTransformation));
  }
  QPixmap empty(kCardPicture);
  empty.fill(colours::kPanel);
  QPainter painter(&empty);
  painter.setPen(colours::kLine);
  painter.drawRect(empty.rect().adjusted(0, 0, -1, -1));
  painter.setPen(colours::kQuiet);
  painter.drawText(empty.rect(), Qt::AlignCenter,
                   entry.problem ? CasesPage::tr("cannot be opened") : CasesPage::tr("no picture"));
  return empty;
}

// As it is, also where it is chosen.
QIcon cardIcon(const CaseEntry& entry) {
  const QPixmap picture = cardPicture(entry);
  QIcon icon(picture);
  icon.addPixmap(picture, QIcon::Selected);
  return icon;
}

}  // namespace

CasesPage::CasesPage(QWidget* parent) : QWidget(parent) {
  cards_ = new QListWidget;
  cards_->setObjectName("cases");
  cards_->setAccessibleName(tr("Cases"));
  cards_->setViewMode(QListView::IconMode);
  cards_->setMovement(QListView::Static);
  cards_->setResizeMode(QListView::Adjust);
  cards_->setIconSize(kCardPicture);
  cards_->setGridSize(kCard);
  cards_->setWordWrap(true);
  cards_->setSpacing(4);
  cards_->setUniformItemSizes(true);
  cards_->setTextElideMode(Qt::ElideRight);
  cards_->installEventFilter(this);
  details_ = buildDetails();
  auto* row = tight(new QHBoxLayout, 10);
  row->addWidget(cards_, 1);
  row->addWidget(details_);
  auto* layout = tight(new QVBoxLayout(this), 10, {16, 12, 16, 12});
  layout->addWidget(buildStrip());
  layout->addLayout(row, 1);
  connect(cards_, &QListWidget::currentItemChanged, this, &CasesPage::showChosen);
  connect(cards_, &QListWidget::itemActivated, this, [this] {
    if (train_->isEnabled()) train_->click();
  });
  showChosen();
  showStrip();
}

// The next step, whoever one is.
QWidget* CasesPage::buildStrip() {
  auto* strip = new QFrame;
  strip->setObjectName("nextStep");
  strip->setProperty("card", true);
  strip_title_ = wrappedLabel("nextStepTitle", {"heading"});
  strip_words_ = wrappedLabel("caseLabel");
  strip_train_ = namedButton("nextTrain", tr("&Train"), true);
  strip_prepare_ = namedButton("nextPrepare", tr("&Prepare"));
  strip_save_ = namedButton("saveCase", tr("&Save the case"), true);
  folder_ = namedButton("openFolder", tr("Open folder of &CT\u2026"));
  folder_->setIcon(symbolIcon(Symbol::open));
  series_ = namedButton("anotherSeries", tr("Use another se&ries\u2026"));
  auto* words = tight(new QVBoxLayout, 4);
  words->addWidget(strip_title_);
  words->addWidget(strip_words_);
  auto* layout = tight(new QHBoxLayout(strip), 8, {14, 10, 14, 10});
  layout->addLayout(words, 1);
  auto* buttons = tight(new QGridLayout, 6);
  buttons->addWidget(strip_save_, 0, 0);
  buttons->addWidget(strip_train_, 0, 1);
  buttons->addWidget(strip_prepare_, 0, 2);
  buttons->addWidget(series_, 1, 1);
  buttons->addWidget(folder_, 1, 2);
  layout->addLayout(buttons);
  connect(folder_, &QPushButton::clicked, this, &CasesPage::folderWanted);
  connect(series_, &QPushButton::clicked, this, &CasesPage::seriesWanted);
  connect(strip_save_, &QPushButton::clicked, this, &CasesPage::saveWanted);
  connect(strip_train_, &QPushButton::clicked, this, [this] { takeNextStep(true); });
  connect(strip_prepare_, &QPushButton::clicked, this, [this] { takeNextStep(false); });
  return strip;
}

QWidget* CasesPage::buildDetails() {
  picture_ = new QLabel;
  picture_->setAlignment(Qt::AlignCenter);
  name_ = wrappedLabel("caseName", {"title"});
  about_ = wrappedLabel("caseAbout");
  done_ = wrappedLabel("caseExercises", {"quiet"});
  train_ = namedButton("trainOnCase", tr("T&rain on it"), true);
  prepare_ = namedButton("prepareCase", tr("Pr&epare it"));
  rename_ = namedButton("renameCase", tr("Re&name\u2026"));
  report_ = namedButton("caseReport", tr("&Import report"));
  delete_ = namedButton("deleteCase", tr("&Delete\u2026"));
  exercises_ = namedButton("caseRecordings", tr("Its e&xercises"));
  auto* page = new QWidget;
  auto* layout = tight(new QVBoxLayout(page), 8, {8, 0, 4, 0});
  layout->addWidget(name_);
  layout->addWidget(picture_);
  layout->addWidget(about_);
  layout->addWidget(train_);
  layout->addWidget(prepare_);
  layout->addWidget(done_);
  auto* more = tight(new QGridLayout, 6);
  more->addWidget(exercises_, 0, 0);
  more->addWidget(report_, 0, 1);
  more->addWidget(rename_, 1, 0);
  more->addWidget(delete_, 1, 1);
  layout->addLayout(more);
  layout->addStretch(1);
  const auto withChosen = [this](auto signal) {
    return [this, signal] {
      if (const CaseEntry* entry = chosen()) emit(this->*signal)(*entry);
    };
  };
  connect(train_, &QPushButton::clicked, this, withChosen(&CasesPage::trainWanted));
  connect(prepare_, &QPushButton::clicked, this, withChosen(&CasesPage::prepareWanted));
  connect(report_, &QPushButton::clicked, this, withChosen(&CasesPage::reportWanted));
  connect(delete_, &QPushButton::clicked, this, withChosen(&CasesPage::deleteWanted));
  connect(exercises_, &QPushButton::clicked, this, withChosen(&CasesPage::exercisesWanted));
  connect(rename_, &QPushButton::clicked, this, [this] {
    if (const CaseEntry* entry = chosen()) askForName(*entry, toQt(entry->record.name));
  });
  QScrollArea* area = scrolled(page, "caseDetails");
  area->setFixedWidth(kDetailsWidth);
  return area;
}

void CasesPage::askForName(const CaseEntry& entry, const QString& name) {
  auto* dialog = new QInputDialog(this);
  dialog->setObjectName("renameDialog");
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setWindowTitle(tr("Rename the case"));
  dialog->setLabelText(tr("A name that does not say who the patient is:"));
  dialog->setTextValue(name);
  connect(dialog, &QInputDialog::textValueSelected, this,
          [this, entry](const QString& wanted) { emit renameWanted(entry, wanted); });
  dialog->open();
}

bool CasesPage::eventFilter(QObject* watched, QEvent* event) {
  if (watched == cards_ && event->type() == QEvent::KeyPress) {
    switch (static_cast<QKeyEvent*>(event)->key()) {
      case Qt::Key_Delete:
        if (!delete_->isHidden() && delete_->isEnabled()) delete_->click();
        return true;
      case Qt::Key_F2:
        if (!rename_->isHidden() && rename_->isEnabled()) rename_->click();
        return true;
      default:
        break;
    }
  }
  return QWidget::eventFilter(watched, event);
}

const CaseEntry* CasesPage::find(const std::string& id) const {
  const auto found = std::ranges::find(entries_, id, &CaseEntry::id);
  return found == entries_.end() ? nullptr : &*found;
}

const CaseEntry* CasesPage::chosen() const {
  const QListWidgetItem* item = cards_->currentItem();
  return item ? find(item->data(kIdRole).toByteArray().toStdString()) : nullptr;
}

void CasesPage::showCases(const std::vector<CaseEntry>& entries) {
  const CaseEntry* before = chosen();
  std::string keep = before ? before->id : open_;
  entries_ = entries;
  if (find(to_select_)) keep = std::exchange(to_select_, {});
  cards_->clear();
  for (const CaseEntry& entry : entries_) {
    auto* item = new QListWidgetItem(cardIcon(entry), cardWords(entry), cards_);
    item->setData(kIdRole, QByteArray::fromStdString(entry.id));  // it need not be UTF-8
    item->setToolTip(detailWords(entry));
    item->setTextAlignment(Qt::AlignHCenter | Qt::AlignTop);
    item->setSizeHint(kCard);
  }
  select(keep);
  if (!cards_->currentItem() && cards_->count() > 0) cards_->setCurrentRow(0);
  showChosen();
  showStrip();
}

void CasesPage::select(const std::string& id) {
  for (int i = 0; i < cards_->count(); ++i) {
    if (cards_->item(i)->data(kIdRole).toByteArray().toStdString() == id) cards_->setCurrentRow(i);
  }
}

void CasesPage::showOpen(const std::string& id, const QString& about, bool saved) {
  any_open_ = true;
  if (std::exchange(open_, id) != id) find(id) ? select(id) : selectOnceThere(id);
  open_about_ = about;
  open_saved_ = saved;
  showStrip();
}

void CasesPage::setRecent(const std::string& id) {
  const bool first = recent_.empty() && open_.empty();
  recent_ = id;
  if (first && !id.empty()) select(id);  // what the heading offers
  showStrip();
}

void CasesPage::sayInStrip(const QString& words) {
  said_ = words;
  showStrip();
}

void CasesPage::setSeriesAtHand(bool at_hand) {
  at_hand_ = at_hand;
  showStrip();
}

void CasesPage::setOpeningAllowed(bool allowed) {
  allowed_ = allowed;
  showChosen();
  showStrip();
}

void CasesPage::showChosen() {
  const CaseEntry* entry = chosen();
  details_->setVisible(entry);
  if (!entry) return;
  picture_->setPixmap(cardPicture(*entry));
  name_->setText(shownName(entry->record.name.empty() ? entry->id : entry->record.name));
  about_->setText(detailWords(*entry));
  showExercises(*entry);
  const bool whole = !entry->problem;
  train_->setEnabled(whole && allowed_);
  prepare_->setEnabled(whole && allowed_);
  rename_->setVisible(entry->isOfLibrary());
  rename_->setEnabled(whole);
  report_->setVisible(entry->isOfLibrary());
  report_->setEnabled(whole && entry->record.verdict);
  delete_->setVisible(entry->isOfLibrary());
  exercises_->setVisible(entry->exercise.empty());
  done_->setVisible(entry->exercise.empty());
}

void CasesPage::showExercises(const CaseEntry& entry) {
  const std::vector<ListedRecording> on_it = exercisesOn(entry);
  exercises_->setEnabled(!on_it.empty());
  QStringList done;
  constexpr std::size_t kMost = 3;
  for (std::size_t i = 0; i < std::min(kMost, on_it.size()); ++i) {
    done << tr("%1, %2").arg(toQt(on_it[i].exercise), timeWords(std::uint32_t(on_it[i].seconds)));
  }
  if (on_it.size() > kMost) done << tr("and %1 more").arg(on_it.size() - kMost);
  if (!done.isEmpty()) done.prepend(tr("Exercises done on it:"));
  if (!no_recordings_.isEmpty()) {
    done << no_recordings_;
  } else if (!all_recordings_) {
    done << tr("Reading the recordings\u2026");
  } else if (done.isEmpty()) {
    done << tr("No exercise has been done on it yet.");
  }
  done_->setText(done.join('\n'));
}

void CasesPage::showRecordings(std::vector<ListedRecording> rows, bool all) {
  // While they are read anew, those of before stay.
  if (!all && rows.size() < recordings_.size()) return;
  recordings_ = std::move(rows);
  all_recordings_ = all;
  no_recordings_.clear();
  if (const CaseEntry* entry = chosen()) showExercises(*entry);
}

void CasesPage::showNoRecordings(const QString& why) {
  no_recordings_ = why;
  all_recordings_ = false;
  if (const CaseEntry* entry = chosen()) showExercises(*entry);
}

std::vector<ListedRecording> CasesPage::exercisesOn(const CaseEntry& entry) const {
  std::vector<ListedRecording> on_it;
  const std::string key = entry.caseKey();
  std::ranges::copy_if(recordings_, std::back_inserter(on_it), [&](const ListedRecording& one) {
    return !key.empty() && one.caseKey() == key;
  });
  return on_it;
}

void CasesPage::takeNextStep(bool train) {
  if (any_open_) return goOnWanted(train);
  const CaseEntry* entry = find(recent_);
  if (!entry) return;
  train ? emit trainWanted(*entry) : emit prepareWanted(*entry);
}

void CasesPage::showStrip() {
  const CaseEntry* recent = find(recent_);
  const bool go_on = any_open_ || (recent && !recent->problem);
  QString title, words;
  if (!said_.isEmpty()) {
    title = said_;
    words = open_about_;
  } else if (any_open_) {
    const CaseEntry* open = find(open_);
    title =
        !open_saved_ ? tr("The open case is not saved yet")
        : open
            ? tr("\"%1\" is open: practise on it, or prepare it").arg(shownName(open->record.name))
            : tr("A case is open: practise on it, or prepare it");
    words = open_about_;
  } else if (recent && !recent->problem) {
    title = tr("Go on with \"%1\"").arg(shownName(recent->record.name));
    words = tr("Or choose another case below, or open a folder of CT.");
  } else {
    title = tr("Choose a case to practise on");
    words =
        tr("Take one of the built-in cases below, or open a folder of CT: it becomes a case of "
           "yours. It can be dropped on this window, too.");
  }
  strip_title_->setText(title);
  strip_words_->setText(words);
  strip_save_->setVisible(any_open_ && !open_saved_);
  strip_train_->setVisible(go_on);
  strip_prepare_->setVisible(go_on);
  strip_train_->setEnabled(allowed_ || any_open_);
  strip_prepare_->setEnabled(allowed_ || any_open_);
  folder_->setEnabled(allowed_);
  series_->setVisible(at_hand_);
  series_->setEnabled(allowed_);
}

}  // namespace trephine
