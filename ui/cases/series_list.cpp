#include "ui/cases/series_list.h"

#include <QPainter>
#include <QStyledItemDelegate>
#include <algorithm>

#include "ui/cases/state_mark.h"
#include "ui/common/colours.h"
#include "ui/common/plain_text.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr int kUid = Qt::UserRole, kState = Qt::UserRole + 1, kLine = Qt::UserRole + 2;
constexpr int kPatientKey = Qt::UserRole + 3, kStudyKey = Qt::UserRole + 4;
constexpr int kPatient = Qt::UserRole + 5, kStudy = Qt::UserRole + 6;
constexpr int kStillFound = -1;  // a state: its scan goes on
constexpr int kPicture = 72, kMargin = 8, kMark = 16;

// Three lines beside the picture: name, line, state.
class SeriesDelegate : public QStyledItemDelegate {
 public:
  using QStyledItemDelegate::QStyledItemDelegate;

  QSize sizeHint(const QStyleOptionViewItem& option, const QModelIndex& index) const override {
    return {180, std::max(kPicture, 3 * option.fontMetrics.height() + 10) + 2 * kMargin +
                     headingHeight(option, index)};
  }

  void paint(QPainter* p, const QStyleOptionViewItem& option,
             const QModelIndex& index) const override {
    p->save();
    paintHeading(*p, option, index);
    const QRect body = option.rect.adjusted(0, headingHeight(option, index), 0, 0);
    const bool selected = option.state & QStyle::State_Selected;
    const bool focused = option.state & QStyle::State_HasFocus;
    if (selected || option.state & QStyle::State_MouseOver) {
      p->setRenderHint(QPainter::Antialiasing);
      p->setPen(selected ? QPen(focused ? colours::kAccent : colours::kLine, 1.5)
                         : QPen(Qt::NoPen));
      p->setBrush(colours::kRaised);
      p->drawRoundedRect(QRectF(body).adjusted(1, 1, -1, -1), 5, 5);
    }
    const QRect inner = body.adjusted(kMargin, kMargin, -kMargin, -kMargin);
    const QRect picture(inner.left(), inner.top() + (inner.height() - kPicture) / 2, kPicture,
                        kPicture);
    paintPicture(*p, picture, index.data(Qt::DecorationRole));
    const QRect text(picture.right() + 12, inner.top(), inner.right() - picture.right() - 12,
                     inner.height());
    paintText(*p, text, option, index);
    p->restore();
  }

 private:
  static int headingHeight(const QStyleOptionViewItem& option, const QModelIndex& index) {
    const auto lines = index.data(kHeadingRole).toStringList().size();
    return lines == 0 ? 0 : int(lines) * (option.fontMetrics.height() + 2) + kMargin;
  }

  // Whose the series below are, and of which study.
  static void paintHeading(QPainter& p, const QStyleOptionViewItem& option,
                           const QModelIndex& index) {
    const QStringList lines = index.data(kHeadingRole).toStringList();
    QRect row(option.rect.left() + kMargin, option.rect.top() + kMargin / 2,
              option.rect.width() - 2 * kMargin, option.fontMetrics.height() + 2);
    for (const QString& line : lines) {
      p.setFont(option.font);
      p.setPen(colours::kText);
      p.drawText(row, Qt::AlignVCenter,
                 option.fontMetrics.elidedText(line, Qt::ElideRight, row.width()));
      row.translate(0, row.height());
    }
  }

  // `thumbnail` is invalid until it has been made, and a null image where there is none.
  static void paintPicture(QPainter& p, const QRect& box, const QVariant& thumbnail) {
    p.fillRect(box, Qt::black);
    if (!thumbnail.isValid()) return;
    const QImage picture = thumbnail.value<QImage>();
    if (picture.isNull()) {
      p.setPen(colours::kQuiet);
      p.drawText(box, Qt::AlignCenter | Qt::TextWordWrap, SeriesList::tr("no picture"));
      return;
    }
    QSize size = picture.size();
    size.scale(box.size(), Qt::KeepAspectRatio);
    QRect at(QPoint(), size);
    at.moveCenter(box.center());
    p.setRenderHint(QPainter::SmoothPixmapTransform);
    p.drawImage(at, picture);
  }

  static void paintText(QPainter& p, const QRect& box, const QStyleOptionViewItem& option,
                        const QModelIndex& index) {
    const QFontMetrics& metrics = option.fontMetrics;
    const int line = metrics.height() + 5;
    QRect row(box.left(), box.top() + (box.height() - 3 * line) / 2, box.width(), line);
    QFont bold = option.font;
    bold.setBold(true);
    p.setFont(bold);
    p.setPen(colours::kText);
    p.drawText(
        row, Qt::AlignVCenter,
        QFontMetrics(bold).elidedText(index.data().toString(), Qt::ElideMiddle, row.width()));
    row.translate(0, line);
    p.setFont(option.font);
    p.setPen(colours::kQuiet);
    p.drawText(row, Qt::AlignVCenter,
               metrics.elidedText(index.data(kLine).toString(), Qt::ElideRight, row.width()));
    row.translate(0, line);
    if (index.data(kState).toInt() == kStillFound) {
      p.drawText(row, Qt::AlignVCenter, SeriesList::tr("Still looking"));
      return;
    }
    const auto state = SeriesState(index.data(kState).toInt());
    paintStateMark(p, QRectF(row.left(), row.center().y() - kMark / 2 + 1, kMark, kMark), state);
    p.setPen(stateColour(state));
    p.drawText(row.adjusted(kMark + 6, 0, 0, 0), Qt::AlignVCenter, stateWord(state));
  }
};

void fill(QListWidgetItem& item, const SeriesReport& series, const Answers& answers) {
  const SeriesState state = seriesState(series, answers);
  const QString name = seriesName(series), line = seriesLine(series);
  item.setText(name);
  item.setData(kUid, toQt(series.uid));
  item.setData(kLine, line);
  item.setData(kState, int(state));
  item.setData(Qt::AccessibleTextRole, QStringList{name, line, stateWord(state)}.join(", "));
  item.setToolTip(inLines(QStringList{name, line, verdictSentence(series, answers)}.join('\n')));
}

}  // namespace

SeriesList::SeriesList(QWidget* parent) : QListWidget(parent) {
  setItemDelegate(new SeriesDelegate(this));
  setMouseTracking(true);
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  setVerticalScrollMode(QAbstractItemView::ScrollPerPixel);
  setAccessibleName(tr("Series of the folder"));
  connect(this, &QListWidget::currentItemChanged, this, [this] { emit seriesSelected(); });
  connect(this, &QListWidget::itemActivated, this, [this] { emit seriesActivated(); });
}

void SeriesList::showSeries(const std::vector<SeriesReport>& series,
                            const std::map<std::string, Answers>& answers,
                            const std::map<std::string, ScreenNames>& names) {
  const std::string selected = selectedUid();
  {
    const QSignalBlocker quiet(this);
    clear();
    for (std::size_t i : seriesOrder(series, answers)) {
      const auto named = names.find(series[i].uid);
      fill(*addItem(named == names.end() ? ScreenNames{} : named->second), series[i],
           answersOf(answers, series[i].uid));
    }
    nameGroups();
    if (QListWidgetItem* same = itemOf(toQt(selected))) setCurrentItem(same);
  }
  emit seriesSelected();
}

void SeriesList::showFound(const std::vector<FoundSeries>& found) {
  for (const FoundSeries& one : found) {
    QListWidgetItem* item = itemOf(toQt(one.uid));
    if (!item) item = addItem(one.names);
    SeriesReport series;
    series.uid = one.uid;
    series.description = one.description;
    series.modality = one.modality;
    series.slices = one.slices;
    fill(*item, series, {});
    const QString state = tr("Still looking");
    item->setData(kState, kStillFound);
    item->setData(Qt::AccessibleTextRole,
                  QStringList{item->text(), item->data(kLine).toString(), state}.join(", "));
    item->setToolTip({});
  }
  nameGroups();
}

// After the last of the same study, of the same patient, or of all.
QListWidgetItem* SeriesList::addItem(const ScreenNames& names) {
  const auto rowAfter = [&](int key, const std::string& value) {
    int row = count();
    while (row > 0 && item(row - 1)->data(key).toString() != toQt(value)) --row;
    return row;
  };
  int row = rowAfter(kStudyKey, names.patient_key + names.study_key);
  if (row == 0) row = rowAfter(kPatientKey, names.patient_key);
  auto* added = new QListWidgetItem;
  added->setData(kPatientKey, toQt(names.patient_key));
  added->setData(kStudyKey, toQt(names.patient_key + names.study_key));
  added->setData(kPatient, toQt(names.patient));
  added->setData(kStudy, toQt(names.study));
  insertItem(row == 0 ? count() : row, added);
  return added;
}

// Who is named once over all that is theirs. One patient or study that is not named needs no
// heading.
void SeriesList::nameGroups() {
  const auto same = [&](int a, int b, int key) { return item(a)->data(key) == item(b)->data(key); };
  const int last = count() - 1;
  for (int row = 0; row <= last; ++row) {
    QListWidgetItem& here = *item(row);
    const bool no_patient = here.data(kPatientKey).toString().isEmpty();
    QString who = here.data(kPatient).toString(), what = here.data(kStudy).toString();
    if (!same(0, last, kStudyKey)) {
      if (who.isEmpty())
        who = no_patient ? tr("Files of no patient") : tr("A patient without a name");
      if (what.isEmpty() && !no_patient) what = tr("A study without a description");
    }
    QStringList lines;
    if (row == 0 || !same(row - 1, row, kPatientKey)) lines << who;
    if (row == 0 || !same(row - 1, row, kStudyKey)) lines << what;
    lines.removeAll(QString());
    here.setData(kHeadingRole, lines);
  }
}

void SeriesList::updateSeries(const SeriesReport& series, const Answers& answers) {
  if (QListWidgetItem* item = itemOf(toQt(series.uid))) fill(*item, series, answers);
}

void SeriesList::setThumbnail(const QString& uid, const QImage& picture) {
  if (QListWidgetItem* item = itemOf(uid)) item->setData(Qt::DecorationRole, picture);
}

void SeriesList::select(const std::string& uid) {
  if (QListWidgetItem* item = itemOf(toQt(uid))) setCurrentItem(item);
}

std::string SeriesList::selectedUid() const {
  return currentItem() ? currentItem()->data(kUid).toString().toStdString() : std::string();
}

std::vector<std::string> SeriesList::withoutThumbnail() const {
  std::vector<std::string> uids;
  for (int row = 0; row < count(); ++row) {
    if (item(row)->data(Qt::DecorationRole).isValid()) continue;
    uids.push_back(item(row)->data(kUid).toString().toStdString());
  }
  return uids;
}

QListWidgetItem* SeriesList::itemOf(const QString& uid) const {
  for (int row = 0; row < count(); ++row) {
    if (item(row)->data(kUid).toString() == uid) return item(row);
  }
  return nullptr;
}

}  // namespace trephine
