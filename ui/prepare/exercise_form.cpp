#include "ui/prepare/exercise_form.h"

#include <QGridLayout>
#include <QMenu>
#include <QVBoxLayout>
#include <algorithm>

#include "exercise/exercise_edits.h"
#include "ui/common/making.h"
#include "ui/common/setting_words.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

QPushButton* way(const char* name, const QString& text, const QString& tip, QWidget* parent) {
  auto* made = named(new QPushButton(text, parent), name);
  made->setToolTip(tip);
  return made;
}

}  // namespace

ExerciseForm::ExerciseForm(QWidget* parent) : QWidget(parent) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(10, 10, 10, 10);
  layout->setSpacing(12);
  layout->addWidget(buildWays());
  locked_ = problemLabel("formLocked", this);
  layout->addWidget(locked_);
  body_ = new QWidget(this);
  auto* groups = tight(new QVBoxLayout(body_), 12);
  buildWhat();
  buildPlaces();
  buildCard();
  outline_ = new OutlineForm(wanted, body_);
  connect(outline_, &OutlineForm::drawingWanted, this, &ExerciseForm::drawingWanted);
  buildLocks();
  for (QWidget* group : std::initializer_list<QWidget*>{what_, places_, card_, outline_, lock_}) {
    groups->addWidget(group);
  }
  layout->addWidget(body_);
  layout->addStretch(1);
  body_->setEnabled(false);
}

// Saving it, trying it, taking it elsewhere.
QWidget* ExerciseForm::buildWays() {
  auto* box = new QWidget(this);
  auto* grid = tight(new QGridLayout(box), 4);
  save_ = way("saveExercise", tr("&Save it"), tr("As an exercise of this workstation"), box);
  copy_ = way("saveExerciseCopy", tr("Save a &copy"), tr("As another one, beside it"), box);
  try_ = way("tryExercise", tr("&Try it"), tr("Go to Train with it; Back comes here again"), box);
  export_ = way("exportExercise", tr("&Export\u2026"),
                tr("One folder with all that it needs, for other workstations"), box);
  import_ = way("importExercise", tr("&Import\u2026"), tr("A folder of another workstation"), box);
  connect(save_, &QPushButton::clicked, this, &ExerciseForm::saveWanted);
  connect(copy_, &QPushButton::clicked, this, &ExerciseForm::saveCopyWanted);
  connect(try_, &QPushButton::clicked, this, &ExerciseForm::tryWanted);
  connect(export_, &QPushButton::clicked, this, &ExerciseForm::exportWanted);
  connect(import_, &QPushButton::clicked, this, &ExerciseForm::importWanted);
  grid->addWidget(try_, 0, 0, 1, 2);
  grid->addWidget(save_, 1, 0);
  grid->addWidget(copy_, 1, 1);
  grid->addWidget(export_, 2, 0);
  grid->addWidget(import_, 2, 1);
  saved_ = wrapped(named(new QLabel(box), "exerciseSaved", {"quiet"}));
  grid->addWidget(saved_, 3, 0, 1, 2);
  return box;
}

// --- What it is ---

void ExerciseForm::buildWhat() {
  what_ = new FormGroup(tr("What it is"), "whatProblem", wanted, body_);
  what_fields_ = what_->addFields<Exercise>(kExerciseFields, "scene:");
  what_fields_->entered = [this](const Exercise& other, const char* key) {
    what_->edit(std::string("exercise ") + key, [&](Exercise& exercise) {
      exercise.name = other.name;
      exercise.anatomy = other.anatomy;
      exercise.structures = other.structures;
    });
  };
  (*what_fields_)["anatomy"].offer({{tr("Head"), "cranium"}, {tr("Abdomen"), "abdomen"}});
  what_->addRow(tr("Case"), buildCase(),
                tr("The open case goes with it, and the structures that are saved in the case."));
  what_->addRow(tr("Other cases"), buildElsewhere(),
                tr("The tissues on a case that lacks a structure which is needed."));
  what_->addRow(tr("Script"), buildOperator(),
                tr("Moves the hands where nobody does, as in a check."));
}

QWidget* ExerciseForm::buildCase() {
  auto* row = new QWidget(what_->fields());
  auto* column = tight(new QVBoxLayout(row), 4);
  case_ = settingText("exerciseCase", row);
  auto* labels = settingButton("chooseLabels", tr("Structures from a file\u2026"),
                               tr("A label map of this case, also from another program"), row);
  connect(labels, &QToolButton::clicked, this, &ExerciseForm::labelsWanted);
  column->addWidget(case_);
  column->addWidget(labels, 0, Qt::AlignLeft);
  return row;
}

QWidget* ExerciseForm::buildElsewhere() {
  QWidget* fields = what_->fields();
  elsewhere_ = settingText("elsewhereSet", fields);
  choose_elsewhere_ = settingButton("chooseElsewhere", tr("Choose\u2026"),
                                    tr("A set of tissues that are known by their HU"), fields);
  no_elsewhere_ = settingButton("noElsewhere", tr("None"),
                                tr("A case that lacks a structure is then refused"), fields);
  choose_elsewhere_->setPopupMode(QToolButton::InstantPopup);
  auto* offered = new QMenu(choose_elsewhere_);
  choose_elsewhere_->setMenu(offered);
  connect(offered, &QMenu::aboutToShow, this, [this, offered] {
    offered->clear();
    for (const auto& [name, file] : sets ? sets() : decltype(sets()){}) {
      offered->addAction(name, this, [this, file = file] { emit elsewhereChosen(file); });
    }
    offered->addSeparator();
    offered->addAction(tr("From a &file\u2026"), this, &ExerciseForm::elsewhereWanted);
  });
  connect(no_elsewhere_, &QToolButton::clicked, this, [this] { setElsewhere({}); });
  return chosenFile(elsewhere_, choose_elsewhere_, no_elsewhere_, fields);
}

QWidget* ExerciseForm::buildOperator() {
  QWidget* fields = what_->fields();
  operator_ = settingText("operatorFile", fields);
  auto* choose =
      settingButton("chooseOperator", tr("Choose\u2026"), tr("An operator script"), fields);
  auto* none = settingButton("noOperator", tr("None"), tr("Nothing moves by itself"), fields);
  connect(choose, &QToolButton::clicked, this, &ExerciseForm::operatorWanted);
  connect(none, &QToolButton::clicked, this, [this] { setOperator({}); });
  return chosenFile(operator_, choose, none, fields);
}

void ExerciseForm::setStructures(const std::vector<std::string>& names) {
  of_case_ = names;
  const Exercise same = exercise_;
  setExercise(same, landmarks_);
}

// Those that it needs, then the case's others.
void ExerciseForm::showStructures() {
  FieldEditor::Offers offers;
  for (const std::string& name : of_case_) {
    const auto same = [&](const std::string& other) { return sameName(name, other); };
    if (std::ranges::none_of(exercise_.structures, same)) offers.emplace_back(toQt(name), name);
  }
  FieldEditor& structures = (*what_fields_)["structures"];
  structures.offer(offers);
  what_fields_->show(exercise_);
  what_->form().setRowVisible(&structures, !offers.empty() || !exercise_.structures.empty());
}

// --- Where ---

namespace {

enum LandmarkWay { kByRay, kByBulk, kByPlace };  // in the order of the list

LandmarkWay wayOf(const Landmark& of) {
  return of.is_place ? kByPlace : isBulk(of) ? kByBulk : kByRay;
}

}  // namespace

void ExerciseForm::buildPlaces() {
  places_ = new FormGroup(tr("Where"), "placeProblem", wanted, body_);
  QWidget* fields = places_->fields();
  landmark_ = settingChoice("landmark", tr("Landmark"), fields);
  connect(landmark_, &QComboBox::activated, this, &ExerciseForm::showLandmark);
  auto* add = settingButton("addLandmark", tr("Add one"), tr("Another place, as this one"), fields);
  auto* remove =
      settingButton("removeLandmark", tr("Remove it"), tr("Where nothing is at it"), fields);
  connect(add, &QToolButton::clicked, this, [this] {
    if (!landmark()) return;
    places_->edit("add landmark", [row = landmark_->currentIndex()](Exercise& exercise) {
      addLandmarkLike(exercise, std::size_t(row));
    });
    landmark_->setCurrentIndex(landmark_->count() - 1);
    showLandmark();
  });
  connect(remove, &QToolButton::clicked, this, [this] {
    if (!landmark()) return;
    places_->edit("remove landmark", [row = landmark_->currentIndex()](Exercise& exercise) {
      exercise.landmarks.erase(exercise.landmarks.begin() + row);
    });
  });
  places_->addRow(tr("Landmark"), besideEachOther({landmark_, add, remove}, fields),
                  tr("A place on any patient, found in the case."));
  constexpr FieldsOf<Landmark> kFields = kLandmarkFields;
  const auto fieldsOf = [this](FieldsOf<Landmark> table) {
    auto made = places_->addFields<Landmark>(table, "landmark:");
    made->entered = [this](const Landmark& other, const char* key) {
      if (!landmark()) return;
      if (other.id != landmark()->id) {
        return places_->edit("landmark name", [&](Exercise& exercise) {
          renameLandmark(exercise, std::size_t(landmark_->currentIndex()), other.id);
        });
      }
      editLandmark(key, [&](Landmark& of) { of = other; });
    };
    return made;
  };
  landmark_is_ = fieldsOf(kFields.first(2));
  landmark_found_ = settingChoice("landmarkFound", tr("How the landmark is found"), fields);
  for (const QString& words :
       {tr("By a ray"), tr("At the most of its tissue"), tr("Where it is clicked")}) {
    landmark_found_->addItem(words);
  }
  connect(landmark_found_, &QComboBox::activated, this, &ExerciseForm::findLandmarkBy);
  places_->addRow(tr("Found"), landmark_found_,
                  tr("On each patient anew; a click is of this one."));
  places_->form().addRow(tr("Entry"), buildEntry());
  landmark_numbers_ = fieldsOf(kFields.subspan(2));
  view_ = places_->addFields<ExerciseView>(kViewFields, "view:");
  view_->entered = [this](const ExerciseView& view, const char* key) {
    places_->edit(std::string("view ") + key, [&](Exercise& exercise) { exercise.view = view; });
  };
  auto* looks = settingButton("keepLooks", tr("Keep the looks as they are"),
                              tr("Shown, ghosted, hidden: as the tissues look now"), fields);
  connect(looks, &QToolButton::clicked, this, &ExerciseForm::looksWanted);
  places_->addRow(tr("Looks"), looks, tr("What is shown, ghosted or hidden at the start."));
}

QWidget* ExerciseForm::buildEntry() {
  auto* row = new QWidget(places_->fields());
  auto* column = tight(new QVBoxLayout(row));
  auto* entry = settingButton(
      "placeEntry", tr("Click it in a view"),
      tr("A click on skin, bone or a slice is the landmark's place from then on"), row);
  connect(entry, &QToolButton::clicked, this, [this] {
    if (landmark()) emit placeWanted(landmark()->id);
  });
  landmark_kind_ = settingHint({}, row);
  landmark_kind_->setObjectName("landmarkKind");
  column->addWidget(entry, 0, Qt::AlignLeft);
  column->addWidget(landmark_kind_);
  return row;
}

const Landmark* ExerciseForm::landmark() const {
  const int row = landmark_->currentIndex();
  const bool there = row >= 0 && std::size_t(row) < exercise_.landmarks.size();
  return there ? &exercise_.landmarks[std::size_t(row)] : nullptr;
}

void ExerciseForm::editLandmark(const std::string& what,
                                const std::function<void(Landmark&)>& change) {
  if (!landmark()) return;
  places_->edit("landmark:" + what, [&](Exercise& exercise) {
    change(exercise.landmarks[std::size_t(landmark_->currentIndex())]);
  });
}

void ExerciseForm::findLandmarkBy(int way) {
  if (way != kByPlace) return editLandmark("found", way == kByBulk ? findByBulk : findByRay);
  showLandmark();  // as it is until it has been clicked
  if (landmark()) emit placeWanted(landmark()->id);
}

void ExerciseForm::showLandmark() {
  const Landmark* of = landmark();
  if (!of) return;
  landmark_found_->setCurrentIndex(wayOf(*of));
  landmark_kind_->setText(of->is_place ? tr("Now: a place of this patient. Del in a slice: its own.")
                          : isBulk(*of)
                              ? tr("Now: towards the most of its tissue, on any patient.")
                              : tr("Now: a ray through the box of its tissue, on any patient."));
  landmark_is_->show(*of);
  landmark_numbers_->show(*of);
}

// --- The card ---

QCheckBox* ExerciseForm::cardSwitch(const char* name, const QString& words,
                                    const std::function<void(Exercise&, bool on)>& edit) {
  auto* box = named(new QCheckBox(words, card_->fields()), name);
  connect(box, &QCheckBox::toggled, this, [this, edit](bool on) {
    if (!showing_) card_->edit("card on", [&](Exercise& exercise) { edit(exercise, on); });
  });
  card_->form().addRow(box);
  return box;
}

std::unique_ptr<FieldRows<CardText>> ExerciseForm::cardFields(const QString& prefix,
                                                              CardText* (*text)(ExerciseCard&)) {
  auto made = card_->addFields<CardText>(kCardFields, prefix);
  made->entered = [this, text](const CardText& wanted_text, const char*) {
    card_->edit("card", [&](Exercise& exercise) {
      CardText* of = exercise.card ? text(*exercise.card) : nullptr;
      if (!of) return;
      *of = wanted_text;
      exercise.card->zh_TW_is_old = exercise.card->zh_TW && of == &exercise.card->en;
    });
  };
  return made;
}

void ExerciseForm::buildCard() {
  card_ = new FormGroup(tr("Card"), "cardProblem", wanted, body_);
  card_on_ = cardSwitch("cardOn", tr("Say what to do before it starts"),
                        [](Exercise& exercise, bool on) {
                          exercise.card.reset();
                          if (!on) return;
                          exercise.card = ExerciseCard{
                              {exercise.name, {tr("Say the first step").toStdString()},
                               tr("Say what each hand does").toStdString()},
                              {}};
                        });
  en_ = cardFields("card:", [](ExerciseCard& card) { return &card.en; });
  chinese_on_ = cardSwitch(
      "cardChineseOn", tr("Also in Traditional Chinese"), [this](Exercise& exercise, bool on) {
        if (!exercise.card) return;
        ExerciseCard& card = *exercise.card;
        if (card.zh_TW) kept_chinese_ = card;  // for who ticks it again
        card = {card.en, {}, false};
        if (!on) return;
        card.zh_TW = kept_chinese_ ? kept_chinese_->zh_TW : card.en;
        card.zh_TW_is_old =
            kept_chinese_ && (kept_chinese_->zh_TW_is_old || kept_chinese_->en != card.en);
      });
  chinese_old_ = problemLabel("chineseOld", card_->fields());
  chinese_old_->setText(tr("The English text was changed after this one: change it, too."));
  card_->form().addRow(chinese_old_);
  zh_ = cardFields("cardChinese:", [](ExerciseCard& card) {
    return card.zh_TW ? &*card.zh_TW : nullptr;
  });
}

void ExerciseForm::forgetCard() {
  kept_chinese_.reset();
  const ExerciseCard card = exercise_.card.value_or(ExerciseCard{});
  en_->show(card.en, false);
  zh_->show(card.zh_TW.value_or(CardText{}), false);
  showCard();
}

void ExerciseForm::showCard() {
  const ExerciseCard* card = exercise_.card ? &*exercise_.card : nullptr;
  const CardText* chinese = card && card->zh_TW ? &*card->zh_TW : nullptr;
  card_on_->setChecked(card);
  chinese_on_->setVisible(card);
  chinese_on_->setChecked(chinese);
  en_->show(card ? card->en : CardText{});
  zh_->show(chinese ? *chinese : CardText{});
  chinese_old_->setVisible(chinese && card->zh_TW_is_old);
  en_->setVisible(card);
  zh_->setVisible(chinese);
}

// --- Locks ---

void ExerciseForm::buildLocks() {
  lock_ = new FormGroup(tr("What stays"), "lockProblem", wanted, body_);
  lock_fields_ = lock_->addFields<Exercise>(kLockFields, "scene:");
  lock_fields_->entered = [this](const Exercise& other, const char* key) {
    lock_->edit(key, [&](Exercise& exercise) { exercise.locks = other.locks; });
  };
  (*lock_fields_)["locks"].describe([](const std::string& lock) {
    return FieldEditor::ChoiceText{lock == "controller" ? tr("Keep the controller")
                                   : lock == "tissues"  ? tr("Keep the tissues")
                                                        : tr("Keep the rate"),
                                   {},
                                   {}};
  });
}

void ExerciseForm::setExercise(const Exercise& exercise,
                               const std::vector<PlacedLandmark>& landmarks) {
  if (exercise != exercise_) {  // what was refused was of another
    for (FormGroup* of : {what_, places_, card_, lock_, static_cast<FormGroup*>(outline_)}) {
      of->forgetRefusal();
    }
  }
  exercise_ = exercise;
  landmarks_ = landmarks;
  showing_ = true;
  body_->setEnabled(locked_->text().isEmpty() && !exercise_.arms.empty());
  showStructures();
  operator_->setText(exercise_.operator_file.empty()
                         ? tr("none")
                         : toQt(std::filesystem::path(exercise_.operator_file).filename()));
  elsewhere_->setText(!choose_elsewhere_->isEnabled() ? tr("in use: this case lacks a structure")
                      : exercise_.tissues_elsewhere   ? shownName(exercise_.tissues_elsewhere->name)
                                                    : tr("none: these tissues everywhere"));
  const int row = std::max(0, landmark_->currentIndex());
  landmark_->clear();
  FieldEditor::Offers looked_at{{tr("The whole case"), ""}}, tissues;
  for (const Landmark& of : exercise_.landmarks) {
    landmark_->addItem(toQt(of.id));
    looked_at.emplace_back(toQt(of.id), of.id);
  }
  for (const Tissue& of : exercise_.tissues.tissues) tissues.emplace_back(shownName(of.name), of.id);
  landmark_->setCurrentIndex(std::min(row, landmark_->count() - 1));
  (*view_)["landmark"].offer(looked_at);
  (*landmark_is_)["tissue"].offer(tissues);
  view_->show(exercise_.view);
  showLandmark();
  showCard();
  outline_->show(exercise_, landmarks_);
  lock_fields_->show(exercise_);
  showing_ = false;
}

void ExerciseForm::setLocked(const QString& why) {
  locked_->setText(why);
  locked_->setVisible(!why.isEmpty());
  body_->setEnabled(why.isEmpty() && !exercise_.arms.empty());
  for (QPushButton* of : {save_, copy_, import_}) of->setEnabled(why.isEmpty());
}

void ExerciseForm::showSaved(const QString& words) {
  saved_->setText(words);
  saved_->setVisible(!words.isEmpty());
}

}  // namespace trephine
