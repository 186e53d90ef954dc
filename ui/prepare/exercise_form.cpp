#include "ui/prepare/exercise_form.h"

#include <QHBoxLayout>
#include <QMenu>
#include <QSignalBlocker>
#include <QVBoxLayout>
#include <algorithm>

#include "base/utf8.h"
#include "exercise/exercise_edits.h"
#include "ui/common/colours.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr int kMostLetters = 80;

QPushButton* way(const char* name, const QString& text, const QString& tip, QWidget* parent) {
  auto* made = new QPushButton(text, parent);
  made->setObjectName(name);
  made->setToolTip(tip);
  return made;
}

QWidget* group(const QString& title, QLabel* problem, QWidget* fields, QWidget* parent) {
  auto* box = new QWidget(parent);
  auto* layout = new QVBoxLayout(box);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(settingTitle(title, box));
  layout->addWidget(problem);
  layout->addWidget(fields);
  return box;
}

QString lockWords(Lock lock) {
  switch (lock) {
    case Lock::controller:
      return ExerciseForm::tr("Keep the controller");
    case Lock::tissues:
      return ExerciseForm::tr("Keep the tissues");
    case Lock::rate:
      return ExerciseForm::tr("Keep the rate");
  }
  return {};
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
  auto* groups = new QVBoxLayout(body_);
  groups->setContentsMargins(0, 0, 0, 0);
  groups->setSpacing(12);
  groups->addWidget(buildWhat());
  groups->addWidget(buildPlaces());
  groups->addWidget(buildCard());
  outline_ = new OutlineForm(body_);
  outline_->wanted = [this](const std::string& what, const std::function<void(Exercise&)>& change) {
    return wanted ? wanted(what, change) : Status();
  };
  connect(outline_, &OutlineForm::drawingWanted, this, &ExerciseForm::drawingWanted);
  groups->addWidget(outline_);
  groups->addWidget(buildLocks());
  layout->addWidget(body_);
  layout->addStretch(1);
  body_->setEnabled(false);
}

// Saving it, trying it, taking it elsewhere.
QWidget* ExerciseForm::buildWays() {
  auto* box = new QWidget(this);
  auto* grid = new QGridLayout(box);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setSpacing(4);
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
  saved_ = new QLabel(box);
  saved_->setObjectName("exerciseSaved");
  saved_->setWordWrap(true);
  saved_->setProperty("quiet", true);
  grid->addWidget(saved_, 3, 0, 1, 2);
  return box;
}

void ExerciseForm::edit(QLabel* problem, const std::string& what,
                        const std::function<void(Exercise&)>& change) {
  if (showing_) return;
  const Status done = wanted ? wanted(what, change) : Status();
  done ? problem->hide() : sayNotApplied(*problem, done.error());
}

// --- What it is ---

QWidget* ExerciseForm::buildWhat() {
  auto* fields = new QWidget(body_);
  QFormLayout* rows = what_form_ = settingForm(fields);
  what_problem_ = problemLabel("whatProblem", body_);
  name_ = new QLineEdit(fields);
  name_->setObjectName("exerciseName");
  name_->setMaxLength(kMostLetters);
  connect(name_, &QLineEdit::editingFinished, this, [this] {
    const std::string typed = cleanUtf8(name_->text().toStdString());
    name_->setModified(false);
    if (typed.empty()) return name_->setText(toQt(exercise_.name));
    if (typed == exercise_.name) return;
    edit(what_problem_, "exercise name", [&](Exercise& exercise) { exercise.name = typed; });
  });
  rows->addRow(tr("Name"), withHint(name_, tr("As it stands in the list of exercises."), fields));
  anatomy_ = settingChoice("anatomy", tr("Part of the body"), fields);
  anatomy_->addItem(tr("Head"), QStringLiteral("cranium"));
  anatomy_->addItem(tr("Abdomen"), QStringLiteral("abdomen"));
  connect(anatomy_, &QComboBox::activated, this, [this](int) {
    const std::string of = anatomy_->currentData().toString().toStdString();
    edit(what_problem_, "anatomy", [&](Exercise& exercise) { exercise.anatomy = of; });
  });
  rows->addRow(
      tr("For"),
      withHint(anatomy_, tr("On a case of another part of the body it asks before it starts."),
               fields));
  structures_ = new QListWidget(fields);
  structures_->setObjectName("neededStructures");
  structures_->setAccessibleName(tr("Structures that it needs"));
  structures_->setMaximumHeight(4 * fontMetrics().height() + 12);
  connect(structures_, &QListWidget::itemChanged, this, [this] {
    std::vector<std::string> names;
    for (int i = 0; i < structures_->count(); ++i) {
      const QListWidgetItem& item = *structures_->item(i);
      if (item.checkState() == Qt::Checked) names.push_back(item.text().toStdString());
    }
    edit(what_problem_, "structures", [&](Exercise& exercise) { exercise.structures = names; });
  });
  rows->addRow(tr("Needs"),
               withHint(structures_, tr("A case that lacks one is helped to it first."), fields));
  case_ = settingText("exerciseCase", fields);
  auto* labels = settingButton("chooseLabels", tr("Structures from a file\u2026"),
                               tr("A label map of this case, also from another program"), fields);
  connect(labels, &QToolButton::clicked, this, &ExerciseForm::labelsWanted);
  auto* of_case = new QWidget(fields);
  auto* case_column = new QVBoxLayout(of_case);
  case_column->setContentsMargins(0, 0, 0, 0);
  case_column->setSpacing(4);
  case_column->addWidget(case_);
  case_column->addWidget(labels, 0, Qt::AlignLeft);
  rows->addRow(tr("Case"),
               withHint(of_case,
                        tr("The open case goes with it, and the structures that are saved "
                           "in the case."),
                        fields));
  const auto fileRow = [&](QLabel*& name, const char* object, QToolButton* choose,
                           QToolButton* none) {
    auto* row = new QWidget(fields);
    auto* grid = new QGridLayout(row);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setSpacing(4);
    name = settingText(object, row);
    grid->addWidget(name, 0, 0, 1, 3);
    grid->addWidget(choose, 1, 0);
    grid->addWidget(none, 1, 1);
    grid->setColumnStretch(2, 1);
    return row;
  };
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
  rows->addRow(
      tr("Other cases"),
      withHint(fileRow(elsewhere_, "elsewhereSet", choose_elsewhere_, no_elsewhere_),
               tr("The tissues on a case that lacks a structure which is needed."), fields));
  auto* choose =
      settingButton("chooseOperator", tr("Choose\u2026"), tr("An operator script"), fields);
  auto* none = settingButton("noOperator", tr("None"), tr("Nothing moves by itself"), fields);
  connect(choose, &QToolButton::clicked, this, &ExerciseForm::operatorWanted);
  connect(none, &QToolButton::clicked, this, [this] { setOperator({}); });
  rows->addRow(tr("Script"),
               withHint(fileRow(operator_, "operatorFile", choose, none),
                        tr("Moves the hands where nobody does, as in a check."), fields));
  return group(tr("What it is"), what_problem_, fields, body_);
}

void ExerciseForm::setOperator(const std::string& file) {
  edit(what_problem_, "operator", [&](Exercise& exercise) { exercise.operator_file = file; });
}

void ExerciseForm::setElsewhere(const std::optional<TissueSet>& set) {
  edit(what_problem_, "elsewhere", [&](Exercise& exercise) { exercise.tissues_elsewhere = set; });
}

void ExerciseForm::showCase(const QString& words) {
  case_->setText(words);
}

void ExerciseForm::setElsewherePossible(bool possible) {
  for (QWidget* of : {choose_elsewhere_, no_elsewhere_}) of->setEnabled(possible);
}

void ExerciseForm::setStructures(const std::vector<std::string>& names) {
  of_case_ = names;
  const Exercise same = exercise_;
  setExercise(same, landmarks_);
}

// --- Where ---

namespace {

constexpr const char *kByRay = "ray", *kByBulk = "bulk", *kByPlace = "place";
constexpr double kUsualBulk_mm = 20.0;

// The direction out of the patient; read as a unit vector.
constexpr NumberOf<Landmark> kOutward[] = {
    {{"outward", {-1, 1}, Given::always, "out of the patient: left, back, up"},
     &Landmark::outward}};

}  // namespace

QWidget* ExerciseForm::buildPlaces() {
  auto* fields = new QWidget(body_);
  place_form_ = settingForm(fields);
  place_problem_ = problemLabel("placeProblem", body_);
  landmark_ = settingChoice("landmark", tr("Landmark"), fields);
  connect(landmark_, &QComboBox::activated, this, [this] { showLandmark(); });
  place_form_->addRow(
      tr("Landmark"),
      withHint(landmark_, tr("A place on any patient, found in the case."), fields));
  auto* of_landmark = new QWidget(fields);
  auto* of_layout = new QGridLayout(of_landmark);
  of_layout->setContentsMargins(0, 0, 0, 0);
  of_layout->setSpacing(4);
  landmark_name_ = new QLineEdit(of_landmark);
  landmark_name_->setObjectName("landmarkName");
  landmark_name_->setAccessibleName(tr("Name of the landmark"));
  landmark_name_->setMaxLength(kMostLetters / 2);
  connect(landmark_name_, &QLineEdit::editingFinished, this, &ExerciseForm::nameLandmark);
  auto* add =
      settingButton("addLandmark", tr("Add one"), tr("Another place, as this one"), of_landmark);
  auto* remove =
      settingButton("removeLandmark", tr("Remove it"), tr("Where nothing is at it"), of_landmark);
  connect(add, &QToolButton::clicked, this, &ExerciseForm::addLandmark);
  connect(remove, &QToolButton::clicked, this, &ExerciseForm::removeLandmark);
  of_layout->addWidget(landmark_name_, 0, 0, 1, 3);
  of_layout->addWidget(add, 1, 0);
  of_layout->addWidget(remove, 1, 1);
  of_layout->setColumnStretch(2, 1);
  place_form_->addRow(tr("Called"),
                      withHint(of_landmark, tr("By this name arms and view have it."), fields));
  landmark_tissue_ = settingChoice("landmarkTissue", tr("Tissue of the landmark"), fields);
  connect(landmark_tissue_, &QComboBox::activated, this, [this](int) {
    const std::string id = landmark_tissue_->currentData().toString().toStdString();
    editLandmark("tissue", [&](Landmark& of) { of.tissue = id; });
  });
  place_form_->addRow(
      tr("On"), withHint(landmark_tissue_, tr("The tissue that its ray meets first."), fields));
  landmark_found_ = settingChoice("landmarkFound", tr("How the landmark is found"), fields);
  landmark_found_->addItem(tr("By a ray"), QString(kByRay));
  landmark_found_->addItem(tr("At the most of its tissue"), QString(kByBulk));
  landmark_found_->addItem(tr("Where it is clicked"), QString(kByPlace));
  connect(landmark_found_, &QComboBox::activated, this,
          [this](int) { findLandmarkBy(landmark_found_->currentData().toString()); });
  place_form_->addRow(
      tr("Found"),
      withHint(landmark_found_, tr("On each patient anew; a click is of this one."), fields));
  auto* entry =
      settingButton("placeEntry", tr("Click it in a view"),
                    tr("A click on skin, bone or a slice is where it enters (I)"), fields);
  connect(entry, &QToolButton::clicked, this, &ExerciseForm::entryWanted);
  landmark_kind_ = settingHint({}, fields);
  landmark_kind_->setObjectName("landmarkKind");
  auto* entry_row = new QWidget(fields);
  auto* entry_layout = new QVBoxLayout(entry_row);
  entry_layout->setContentsMargins(0, 0, 0, 0);
  entry_layout->addWidget(entry, 0, Qt::AlignLeft);
  entry_layout->addWidget(landmark_kind_);
  place_form_->addRow(tr("Entry"), entry_row);
  const auto numbers = [&](std::span<const NumberOf<Landmark>> of) {
    auto made = std::make_unique<NumberRows<Landmark>>(of, *place_form_, fields, "landmark:");
    made->entered = [this](const Landmark& other, const char* key) {
      editLandmark(key, [&](Landmark& landmark) { landmark = other; });
    };
    return made;
  };
  ray_ = numbers(kRayNumbers);
  bulk_ = numbers(kBulkNumbers);
  place_ = numbers(kPlaceNumbers);
  outward_ = numbers(kOutward);
  outward_->entered = [this](const Landmark& other, const char* key) {
    if (!(glm::length(other.outward) > 0.0)) {
      place_problem_->setText(tr("Not applied. A direction has a length: leave one of the three."));
      place_problem_->show();
      return showLandmark();
    }
    editLandmark(key,
                 [&](Landmark& landmark) { landmark.outward = glm::normalize(other.outward); });
  };
  run_ = numbers(kLandmarkNumbers);
  view_landmark_ = settingChoice("viewLandmark", tr("Looked at"), fields);
  connect(view_landmark_, &QComboBox::activated, this, [this](int) {
    const std::string id = view_landmark_->currentData().toString().toStdString();
    edit(place_problem_, "view landmark", [&](Exercise& exercise) { exercise.view.landmark = id; });
  });
  place_form_->addRow(tr("Look at"),
                      withHint(view_landmark_, tr("Where the camera begins."), fields));
  view_numbers_ = std::make_unique<NumberRows<ExerciseView>>(
      std::span<const NumberOf<ExerciseView>>(kViewNumbers), *place_form_, fields, "view:");
  view_numbers_->entered = [this](const ExerciseView& view, const char* key) {
    edit(place_problem_, key, [&](Exercise& exercise) { exercise.view = view; });
  };
  auto* looks = settingButton("keepLooks", tr("Keep the looks as they are"),
                              tr("Shown, ghosted, hidden: as the tissues look now"), fields);
  connect(looks, &QToolButton::clicked, this, &ExerciseForm::looksWanted);
  place_form_->addRow(
      tr("Looks"), withHint(looks, tr("What is shown, ghosted or hidden at the start."), fields));
  return group(tr("Where"), place_problem_, fields, body_);
}

void ExerciseForm::editLandmark(const std::string& what,
                                const std::function<void(Landmark&)>& change) {
  const int row = landmark_->currentIndex();
  if (row < 0 || std::size_t(row) >= exercise_.landmarks.size()) return;
  edit(place_problem_, "landmark:" + what,
       [&](Exercise& exercise) { change(exercise.landmarks[std::size_t(row)]); });
}

// Whatever names it goes along.
void ExerciseForm::nameLandmark() {
  const int row = landmark_->currentIndex();
  const std::string typed = cleanUtf8(landmark_name_->text().toStdString());
  landmark_name_->setModified(false);
  if (row < 0 || std::size_t(row) >= exercise_.landmarks.size()) return;
  const std::string before = exercise_.landmarks[std::size_t(row)].id;
  if (typed.empty()) return landmark_name_->setText(toQt(before));
  if (typed == before) return;
  edit(place_problem_, "landmark name", [&](Exercise& exercise) {
    exercise.landmarks[std::size_t(row)].id = typed;
    for (ExerciseArm& arm : exercise.arms) {
      if (arm.map.landmark == before) arm.map.landmark = typed;
    }
    if (exercise.view.landmark == before) exercise.view.landmark = typed;
    if (exercise.outline && exercise.outline->frame && exercise.outline->frame->landmark == before) {
      exercise.outline->frame->landmark = typed;
    }
  });
}

void ExerciseForm::findLandmarkBy(const QString& kind) {
  if (kind == kByPlace) {
    showLandmark();  // as it is until it has been clicked
    return emit entryWanted();
  }
  const bool bulk = kind == kByBulk;
  editLandmark("found", [&](Landmark& of) {
    of.is_place = false;
    of.bulk_radius_mm = bulk ? kUsualBulk_mm : 0.0;
    if (bulk && !(glm::length(of.outward) > 0.0)) of.outward = Vec3(0.0, 0.0, 1.0);
    if (!bulk && of.from == of.towards) {  // from above to the middle
      of.from = Vec3(0.5, 0.5, 1.5);
      of.towards = Vec3(0.5, 0.5, 0.5);
    }
  });
}

void ExerciseForm::addLandmark() {
  const int row = landmark_->currentIndex();
  if (row < 0 || std::size_t(row) >= exercise_.landmarks.size()) return;
  Landmark more = exercise_.landmarks[std::size_t(row)];
  int number = 2;
  while (exercise_.findLandmarkById("place-" + std::to_string(number))) ++number;
  more.id = "place-" + std::to_string(number);
  edit(place_problem_, "add landmark", [&](Exercise& exercise) { exercise.landmarks.push_back(more); });
  landmark_->setCurrentIndex(landmark_->count() - 1);
  showLandmark();
}

void ExerciseForm::removeLandmark() {
  const int row = landmark_->currentIndex();
  if (row < 0 || std::size_t(row) >= exercise_.landmarks.size()) return;
  edit(place_problem_, "remove landmark",
       [&](Exercise& exercise) { exercise.landmarks.erase(exercise.landmarks.begin() + row); });
}

void ExerciseForm::showLandmark() {
  const int row = landmark_->currentIndex();
  if (row < 0 || std::size_t(row) >= exercise_.landmarks.size()) return;
  const Landmark& of = exercise_.landmarks[std::size_t(row)];
  landmark_tissue_->setCurrentIndex(landmark_tissue_->findData(toQt(of.tissue)));
  const bool bulk = !of.is_place && of.bulk_radius_mm > 0.0;
  landmark_found_->setCurrentIndex(landmark_found_->findData(QString(of.is_place ? kByPlace
                                                                     : bulk      ? kByBulk
                                                                                 : kByRay)));
  landmark_kind_->setText(of.is_place ? tr("Now: a place of this patient. Del in a slice: its own.")
                          : bulk      ? tr("Now: towards the most of its tissue, on any patient.")
                                      : tr("Now: a ray through the box of its tissue, on any "
                                           "patient."));
  ray_->setVisible(!of.is_place && !bulk);
  bulk_->setVisible(bulk);
  place_->setVisible(of.is_place);
  outward_->setVisible(of.is_place || bulk);
  for (auto* rows : {&ray_, &bulk_, &place_, &outward_, &run_}) (*rows)->show(of);
  if (!landmark_name_->hasFocus() || !landmark_name_->isModified()) {
    landmark_name_->setText(toQt(of.id));
  }
}

// --- The card ---

ExerciseForm::CardFields ExerciseForm::buildLanguage(QWidget* page, const QString& suffix) {
  auto* rows = settingForm(page);
  CardFields fields{new QLineEdit(page), new QPlainTextEdit(page), new QLineEdit(page)};
  fields.goal->setObjectName("cardGoal" + suffix);
  fields.goal->setAccessibleName(tr("Goal"));
  fields.steps->setObjectName("cardSteps" + suffix);
  fields.steps->setAccessibleName(tr("Steps, a line each"));
  fields.steps->setTabChangesFocus(true);
  fields.steps->setFixedHeight(6 * fontMetrics().height());
  fields.hands->setObjectName("cardHands" + suffix);
  fields.hands->setAccessibleName(tr("Hands"));
  rows->addRow(tr("Goal"), withHint(fields.goal, tr("What is to be reached."), page));
  rows->addRow(tr("Steps"), withHint(fields.steps, tr("One a line, in their order."), page));
  rows->addRow(tr("Hands"),
               withHint(fields.hands, tr("Which tool in which hand, and how to move it."), page));
  connect(fields.goal, &QLineEdit::editingFinished, this, &ExerciseForm::cardEntered);
  connect(fields.hands, &QLineEdit::editingFinished, this, &ExerciseForm::cardEntered);
  fields.steps->installEventFilter(this);
  return fields;
}

QWidget* ExerciseForm::buildCard() {
  auto* fields = new QWidget(body_);
  auto* column = new QVBoxLayout(fields);
  column->setContentsMargins(0, 0, 0, 0);
  card_problem_ = problemLabel("cardProblem", body_);
  card_on_ = new QCheckBox(tr("Say what to do before it starts"), fields);
  card_on_->setObjectName("cardOn");
  en_page_ = new QWidget(fields);
  en_ = buildLanguage(en_page_, "");
  chinese_on_ = new QCheckBox(tr("Also in Traditional Chinese"), fields);
  chinese_on_->setObjectName("cardChineseOn");
  zh_page_ = new QWidget(fields);
  zh_ = buildLanguage(zh_page_, "Chinese");
  column->addWidget(card_on_);
  column->addWidget(en_page_);
  column->addWidget(chinese_on_);
  column->addWidget(zh_page_);
  connect(card_on_, &QCheckBox::toggled, this, [this](bool on) {
    edit(card_problem_, "card on", [&](Exercise& exercise) {
      exercise.card.reset();
      if (on) {
        exercise.card = ExerciseCard{{exercise.name, {tr("Say the first step").toStdString()},
                                tr("Say what each hand does").toStdString()},
                               {}};
      }
    });
  });
  connect(chinese_on_, &QCheckBox::toggled, this, [this](bool on) {
    edit(card_problem_, "card on", [&](Exercise& exercise) {
      if (!exercise.card) return;
      if (exercise.card->zh_TW) kept_chinese_ = exercise.card->zh_TW;  // for who ticks it again
      exercise.card->zh_TW.reset();
      if (on) exercise.card->zh_TW = kept_chinese_ ? *kept_chinese_ : exercise.card->en;
    });
  });
  return group(tr("Card"), card_problem_, fields, body_);
}

CardText ExerciseForm::textOf(const CardFields& fields) {
  CardText text{cleanUtf8(fields.goal->text().toStdString()), {},
                cleanUtf8(fields.hands->text().toStdString())};
  for (const QString& line : fields.steps->toPlainText().split('\n')) {
    const std::string step = cleanUtf8(line.toStdString());
    if (!step.empty()) text.steps.push_back(step);
  }
  return text;
}

void ExerciseForm::cardEntered() {
  if (showing_ || !exercise_.card) return;
  edit(card_problem_, "card", [this](Exercise& exercise) {
    exercise.card->en = textOf(en_);
    if (exercise.card->zh_TW) exercise.card->zh_TW = textOf(zh_);
  });
}

bool ExerciseForm::eventFilter(QObject* watched, QEvent* event) {
  const bool steps = watched == en_.steps || watched == zh_.steps;
  if (steps && event->type() == QEvent::FocusOut) cardEntered();
  return QWidget::eventFilter(watched, event);
}

void ExerciseForm::showText(CardFields& fields, const CardText* text) {
  const CardText none;
  const CardText& of = text ? *text : none;
  // What is being typed stays.
  for (const auto& [field, words] : {std::pair(fields.goal, &of.goal), {fields.hands, &of.hands}}) {
    if (field->hasFocus()) continue;
    field->setText(toQt(*words));
    field->setCursorPosition(0);
    field->setToolTip(toQt(*words));
  }
  QStringList steps;
  for (const std::string& step : of.steps) steps << toQt(step);
  if (!fields.steps->hasFocus() && fields.steps->toPlainText() != steps.join('\n')) {
    fields.steps->setPlainText(steps.join('\n'));
  }
}

void ExerciseForm::showCard() {
  card_on_->setChecked(exercise_.card.has_value());
  en_page_->setVisible(exercise_.card.has_value());
  chinese_on_->setVisible(exercise_.card.has_value());
  const bool chinese = exercise_.card && exercise_.card->zh_TW;
  chinese_on_->setChecked(chinese);
  zh_page_->setVisible(chinese);
  showText(en_, exercise_.card ? &exercise_.card->en : nullptr);
  showText(zh_, chinese ? &*exercise_.card->zh_TW : nullptr);
}

// --- Locks ---

QWidget* ExerciseForm::buildLocks() {
  auto* fields = new QWidget(body_);
  auto* column = new QVBoxLayout(fields);
  column->setContentsMargins(0, 0, 0, 0);
  lock_problem_ = problemLabel("lockProblem", body_);
  for (std::size_t i = 0; i < kLockNames.size(); ++i) {
    const Lock lock = kLockNames[i].second;
    auto* check = new QCheckBox(lockWords(lock), fields);
    check->setObjectName("lock:" + QString::fromUtf8(kLockNames[i].first.data(),
                                                     qsizetype(kLockNames[i].first.size())));
    connect(check, &QCheckBox::toggled, this, [this, lock](bool on) {
      edit(lock_problem_, "locks", [&](Exercise& exercise) {
        on ? void(exercise.locks.insert(lock)) : void(exercise.locks.erase(lock));
      });
    });
    column->addWidget(check);
    locks_[i] = check;
  }
  column->addWidget(settingHint(tr("What a trainee may not change while the exercise is practised."),
                                fields));
  return group(tr("What stays"), lock_problem_, fields, body_);
}

void ExerciseForm::setExercise(const Exercise& exercise, const std::vector<PlacedLandmark>& landmarks) {
  if (exercise != exercise_) {  // what was refused was of another
    for (QLabel* problem : {what_problem_, place_problem_, card_problem_, lock_problem_}) {
      problem->hide();
    }
    outline_->forgetRefusal();
  }
  exercise_ = exercise;
  landmarks_ = landmarks;
  showing_ = true;
  body_->setEnabled(locked_->text().isEmpty() && !exercise_.arms.empty());
  if (!name_->hasFocus() || !name_->isModified()) name_->setText(toQt(exercise_.name));
  const QString anatomy = toQt(exercise_.anatomy);
  if (anatomy_->findData(anatomy) < 0) anatomy_->addItem(anatomy, anatomy);
  anatomy_->setCurrentIndex(anatomy_->findData(anatomy));
  structures_->clear();
  std::vector<std::string> names = exercise_.structures;
  for (const std::string& name : of_case_) {
    const auto same = [&](const std::string& other) { return sameName(name, other); };
    if (std::ranges::none_of(names, same)) names.push_back(name);
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    auto* item = new QListWidgetItem(toQt(names[i]), structures_);
    item->setFlags(item->flags() | Qt::ItemIsUserCheckable);
    item->setCheckState(i < exercise_.structures.size() ? Qt::Checked : Qt::Unchecked);
  }
  what_form_->setRowVisible(structures_->parentWidget(), !names.empty());
  operator_->setText(exercise_.operator_file.empty()
                         ? tr("none")
                         : toQt(std::filesystem::path(exercise_.operator_file).filename()));
  elsewhere_->setText(!choose_elsewhere_->isEnabled() ? tr("in use: this case lacks a structure")
                      : exercise_.tissues_elsewhere      ? shownName(exercise_.tissues_elsewhere->name)
                                                      : tr("none: these tissues everywhere"));
  const int row = std::max(0, landmark_->currentIndex());
  landmark_->clear();
  view_landmark_->clear();
  view_landmark_->addItem(tr("The whole case"), QString());
  for (const Landmark& of : exercise_.landmarks) {
    landmark_->addItem(toQt(of.id));
    view_landmark_->addItem(toQt(of.id), toQt(of.id));
  }
  landmark_->setCurrentIndex(std::min(row, landmark_->count() - 1));
  view_landmark_->setCurrentIndex(view_landmark_->findData(toQt(exercise_.view.landmark)));
  landmark_tissue_->clear();
  for (const Tissue& of : exercise_.tissues.tissues) {
    landmark_tissue_->addItem(shownName(of.name), toQt(of.id));
  }
  view_numbers_->show(exercise_.view);
  showLandmark();
  showCard();
  outline_->show(exercise_, landmarks_);
  for (std::size_t i = 0; i < locks_.size(); ++i) {
    locks_[i]->setChecked(exercise_.locks.contains(kLockNames[i].second));
  }
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
