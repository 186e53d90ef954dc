#include "ui/structures/structure_report.h"

#include <QDialogButtonBox>
#include <QHeaderView>
#include <QImage>
#include <QLabel>
#include <QTreeWidget>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "ui/common/making.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr int kPicture_pixels = 112;
enum Column { kName, kMl, kHu, kNoticed };

QString millilitres(double ml) {
  return QString::number(ml, 'f', ml < 10.0 ? 2 : 0);
}

// On the case's grid, and in the file where that is another.
QString volumeWords(const StructureCard& card) {
  const bool alike = std::abs(card.ml - card.ml_in_file) <= 0.01 * card.ml_in_file;
  return alike ? millilitres(card.ml)
               : StructureReport::tr("%1\n(%2 in the file)")
                     .arg(millilitres(card.ml), millilitres(card.ml_in_file));
}

QString huWords(const StructureCard& card) {
  if (!card.hu) return {};
  const auto [low, middle, high] = *card.hu;
  return StructureReport::tr("%1\n(%2 to %3)")
      .arg(middle, 0, 'f', 0)
      .arg(low, 0, 'f', 0)
      .arg(high, 0, 'f', 0);
}

QString noticeWords(const StructureCard& card) {
  QStringList words;
  for (const Finding& finding : card.findings) words << toQt(finding.text) + '.';
  return words.join('\n');
}

}  // namespace

StructureReport::StructureReport(const Case& of, QWidget* parent) : QDialog(parent) {
  setObjectName("structureReport");
  setAttribute(Qt::WA_DeleteOnClose);
  setAttribute(Qt::WA_ShowWithoutActivating);  // the keys stay where they are
  build();
  QStringList words;
  for (const Warning& warning : of.structure_warnings) words << toQt(warning.text);
  if (words.isEmpty()) words << tr("They lie on the CT.");
  said_->setText(words.join('\n'));
  for (const StructureCard& card : of.structure_cards) {
    auto* item = new QTreeWidgetItem(list_);
    item->setText(kName, toQt(card.name));
    item->setText(kMl, volumeWords(card));
    item->setText(kHu, huWords(card));
    item->setText(kNoticed, noticeWords(card));
    item->setTextAlignment(kMl, Qt::AlignRight | Qt::AlignVCenter);
    QPixmap none(kPicture_pixels, kPicture_pixels);
    none.fill(Qt::transparent);
    item->setIcon(kName, none);
  }
  for (Column column : {kName, kMl, kHu}) list_->resizeColumnToContents(column);
  if (!of.structure_cards.empty()) drawPictures(of);
}

void StructureReport::build() {
  setWindowTitle(tr("Structures that were found"));
  said_ = wrappedLabel("structureReportSaid");
  said_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  list_ = new QTreeWidget(this);
  list_->setObjectName("structureReportList");
  list_->setHeaderLabels({tr("Structure"), tr("mL"), tr("HU: middle (5 to 95 %)"), tr("Noticed")});
  list_->setRootIsDecorated(false);
  list_->setWordWrap(true);
  list_->setSelectionMode(QAbstractItemView::NoSelection);
  list_->setIconSize({kPicture_pixels, kPicture_pixels});
  list_->setVerticalScrollMode(QAbstractItemView::ScrollPerPixel);
  list_->header()->setStretchLastSection(true);
  auto* close = new QDialogButtonBox(QDialogButtonBox::Close, this);
  connect(close, &QDialogButtonBox::rejected, this, &QDialog::close);
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(said_);
  layout->addWidget(list_, 1);
  layout->addWidget(close);
  resize(720, 560);
}

void StructureReport::drawPictures(const Case& of) {
  drawing_.run(
      [volume = of.volume, map = of.structures,
       cards = of.structure_cards](const Progress& progress) -> Result<Pictures> {
        const StructurePictures pictures(*volume, kPicture_pixels);
        Pictures made;
        for (const StructureCard& card : cards) {
          if (progress.cancelled()) break;
          made.push_back(pictures.of(*map, card.label, card.colour));
        }
        return made;
      },
      [this](const Result<Pictures>& made) {
        if (made) showPictures(*made);  // else the numbers alone
      });
}

void StructureReport::showPictures(const Pictures& pictures) {
  const int count = std::min(list_->topLevelItemCount(), int(pictures.size()));
  for (int row = 0; row < count; ++row) {
    const ColourPicture& picture = pictures[std::size_t(row)];
    const QImage image(picture.rgb.data(), picture.width, picture.height, 3 * picture.width,
                       QImage::Format_RGB888);
    list_->topLevelItem(row)->setIcon(kName, QPixmap::fromImage(image));
    list_->setIconSize(image.size());  // one for all: they show the same scan
  }
}

}  // namespace trephine
