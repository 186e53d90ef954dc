// The series of a folder: a picture, the description, what it is, and its state in shape, colour
// and word; grouped by patient and study. Usable CT comes first.
#pragma once

#include <QListWidget>
#include <map>

#include "ui/cases/import_words.h"

namespace trephine {

// Of an item: the lines over it, where a patient or study begins.
constexpr int kHeadingRole = Qt::UserRole + 7;

class SeriesList : public QListWidget {
  Q_OBJECT
 public:
  explicit SeriesList(QWidget* parent = nullptr);

  // Shows these in the order of seriesOrder(), those of one patient and study together under their
  // names; `answers` are those given so far, by uid, as `names` are.
  void showSeries(const std::vector<SeriesReport>& series,
                  const std::map<std::string, Answers>& answers,
                  const std::map<std::string, ScreenNames>& names = {});
  // What a scan has found so far: what is there stays where it is and grows.
  void showFound(const std::vector<FoundSeries>& found);
  // What reading or answering has changed about one of them; the order stays.
  void updateSeries(const SeriesReport& series, const Answers& answers);
  void setThumbnail(const QString& uid, const QImage& picture);
  void select(const std::string& uid);
  std::string selectedUid() const;  // empty where nothing is
  std::vector<std::string> withoutThumbnail() const;

 signals:
  void seriesSelected();
  void seriesActivated();  // Return, or a double click

 private:
  QListWidgetItem* itemOf(const QString& uid) const;
  QListWidgetItem* addItem(const ScreenNames& names);
  void nameGroups();
};

}  // namespace trephine
