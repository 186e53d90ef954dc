#include "ui/cases/series_list.h"

#include <QPainter>
#include <QStyledItemDelegate>
#include <algorithm>
#include <numeric>
#include <tuple>

#include "ui/cases/state_mark.h"
#include "ui/common/colours.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr int kUid = Qt::UserRole, kState = Qt::UserRole + 1, kLine = Qt::UserRole + 2;
constexpr int kPicture = 72, kMargin = 8, kMark = 16;

const Answers& answersOf(const std::map<std::string, Answers>& answers, const std::string& uid) {
  static const Answers none;
  const auto found = answers.find(uid);
  return found == answers.end() ? none : found->second;
}

// Three lines beside the picture: name, line, state.
class SeriesDelegate : public QStyledItemDelegate {
 public:
  using QStyledItemDelegate::QStyledItemDelegate;

  QSize sizeHint(const QStyleOptionViewItem& option, const QModelIndex&) const override {
    return {180, std::max(kPicture, 3 * option.fontMetrics.height() + 10) + 2 * kMargin};
  }

  void paint(QPainter* p, const QStyleOptionViewItem& option,
             const QModelIndex& index) const override {
    p->save();
    const bool selected = option.state & QStyle::State_Selected;
    const bool focused = option.state & QStyle::State_HasFocus;
    if (selected || option.state & QStyle::State_MouseOver) {
      p->setRenderHint(QPainter::Antialiasing);
      p->setPen(selected ? QPen(focused ? colours::kAccent : colours::kLine, 1.5)
                         : QPen(Qt::NoPen));
      p->setBrush(colours::kRaised);
      p->drawRoundedRect(QRectF(option.rect).adjusted(1, 1, -1, -1), 5, 5);
    }
    const QRect inner = option.rect.adjusted(kMargin, kMargin, -kMargin, -kMargin);
    const QRect picture(inner.left(), inner.top() + (inner.height() - kPicture) / 2, kPicture,
                        kPicture);
    paintPicture(*p, picture, index.data(Qt::DecorationRole));
    const QRect text(picture.right() + 12, inner.top(), inner.right() - picture.right() - 12,
                     inner.height());
    paintText(*p, text, option, index);
    p->restore();
  }

 private:
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
    p.drawText(row, Qt::AlignVCenter,
               QFontMetrics(bold).elidedText(index.data().toString(), Qt::ElideRight, row.width()));
    row.translate(0, line);
    p.setFont(option.font);
    p.setPen(colours::kQuiet);
    p.drawText(row, Qt::AlignVCenter,
               metrics.elidedText(index.data(kLine).toString(), Qt::ElideRight, row.width()));
    row.translate(0, line);
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
  item.setToolTip(QString("<b>%1</b><br>%2<br>%3")
                      .arg(name.toHtmlEscaped(), line.toHtmlEscaped(),
                           verdictSentence(series, answers).toHtmlEscaped()));
}

}  // namespace

std::vector<std::size_t> seriesOrder(const std::vector<SeriesReport>& series,
                                     const std::map<std::string, Answers>& answers) {
  std::vector<std::size_t> order(series.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  const auto rank = [&](std::size_t i) {
    const SeriesReport& one = series[i];
    const SeriesState state = seriesState(one, answersOf(answers, one.uid));
    const int usable = mayBeRead(state) ? 0 : state == SeriesState::asks ? 1 : 2;
    return std::tuple(usable, one.modality == "CT" ? 0 : 1, -one.slices);
  };
  std::ranges::stable_sort(order, {}, rank);
  return order;
}

SeriesList::SeriesList(QWidget* parent) : QListWidget(parent) {
  setItemDelegate(new SeriesDelegate(this));
  setMouseTracking(true);
  setUniformItemSizes(true);
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  setVerticalScrollMode(QAbstractItemView::ScrollPerPixel);
  setAccessibleName(tr("Series of the folder"));
  connect(this, &QListWidget::currentItemChanged, this, [this] { emit seriesSelected(); });
  connect(this, &QListWidget::itemActivated, this, [this] { emit seriesActivated(); });
}

void SeriesList::showSeries(const std::vector<SeriesReport>& series,
                            const std::map<std::string, Answers>& answers) {
  const std::string selected = selectedUid();
  {
    const QSignalBlocker quiet(this);
    clear();
    for (std::size_t i : seriesOrder(series, answers)) {
      fill(*new QListWidgetItem(this), series[i], answersOf(answers, series[i].uid));
    }
    if (QListWidgetItem* same = itemOf(toQt(selected))) setCurrentItem(same);
  }
  emit seriesSelected();
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
