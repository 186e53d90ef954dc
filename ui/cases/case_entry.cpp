#include "ui/cases/case_entry.h"

#include <QBuffer>
#include <QCoreApplication>
#include <QDateTime>
#include <QImageReader>
#include <QLocale>
#include <algorithm>
#include <utility>

#include "base/file.h"
#include "base/system.h"
#include "exchange/exercise_folder.h"
#include "exercise/exercise.h"
#include "library/case_folders.h"
#include "ui/cases/import_words.h"
#include "ui/common/words.h"
#include "volume/volume_files.h"

namespace trephine {

namespace {

constexpr int kStructuresNamed = 6;

QString tr(const char* text) {
  return QCoreApplication::translate("trephine", text);
}

QString regionWords(BodyRegion region) {
  return region == BodyRegion::head      ? tr("A head")
         : region == BodyRegion::abdomen ? tr("An abdomen")
                                         : tr("What it shows is not known");
}

template <class Structures>
QString structureNames(const Structures& structures, int most) {
  QStringList names;
  for (const auto& s : structures) names << shownName(s.name);
  const int more = int(names.size()) - most;
  const QString first = QStringList(names.mid(0, most)).join(", ");
  return more > 0 ? tr("%1 and %2 more").arg(first).arg(more) : first;
}

CaseEntry builtIn(const std::string& name) {
  CaseEntry entry;
  entry.id = name;
  entry.built_in = true;
  entry.record.name = builtInName(name).toStdString();
  entry.record.region = name == "cranium" ? BodyRegion::head : BodyRegion::abdomen;
  if (const auto geometry = phantomGeometry(name)) entry.record.grid = *geometry;
  (void)entry.picture.load(toQt(resourceFolder() / "cases" / (name + ".png")));
  return entry;
}

// Null where it is none of ours: another format, which a plugin would read, or a size that takes
// seconds.
QImage pictureIn(const std::filesystem::path& file) {
  constexpr std::size_t kMostBytes = std::size_t{8} << 20;
  constexpr int kMost_px = 2048;
  const Result<std::string> bytes = readWholeFile(file, kMostBytes);
  if (!bytes) return {};
  QByteArray data = QByteArray::fromStdString(*bytes);
  QBuffer buffer(&data);
  QImageReader reader(&buffer, "png");
  reader.setAutoDetectImageFormat(false);
  const QSize size = reader.size();
  if (size.isEmpty() || size.width() > kMost_px || size.height() > kMost_px) return {};
  return reader.read();
}

// An exercise that has its case in its own folder; else nothing.
std::optional<CaseEntry> broughtBy(const std::filesystem::path& file) {
  const Result<Exercise> exercise = readExercise(file);
  if (!exercise) return {};
  const std::filesystem::path folder = file.parent_path(), source = exercise->case_source;
  const auto parts = std::mismatch(folder.begin(), folder.end(), source.begin(), source.end());
  if (source.empty() || parts.first != folder.end()) return {};
  CaseEntry entry;
  entry.id = idOfExercise(file);
  entry.exercise = file;
  entry.record.name = exercise->name;
  entry.record.region = exercise->anatomy == exerciseAnatomy(BodyRegion::head) ? BodyRegion::head
                        : exercise->anatomy == exerciseAnatomy(BodyRegion::abdomen)
                            ? BodyRegion::abdomen
                            : BodyRegion::not_sure;
  const auto header = readVolumeFileHeader(source);
  if (header) {
    entry.record.grid = header->geometry;
  } else {
    entry.problem = header.error();
  }
  entry.picture = pictureIn(folder / case_folders::kPictureFile);
  return entry;
}

}  // namespace

std::string idOfExercise(const std::filesystem::path& exercise_file) {
  return "exercise:" + exercise_file.parent_path().filename().string();
}

QString cardWords(const CaseEntry& entry) {
  QStringList lines{shownName(entry.record.name.empty() ? entry.id : entry.record.name)};
  if (entry.problem) {
    lines << tr("Cannot be opened");
  } else if (!entry.exercise.empty()) {
    lines << tr("Exercise with its case");
  } else {
    if (entry.built_in) {
      lines << regionWords(entry.record.region);
    } else if (entry.record.verdict) {
      lines << verdictWord(*entry.record.verdict);
    }
    const std::size_t structures = entry.record.structures.size();
    if (structures == 1) lines << tr("1 structure");
    if (structures > 1) lines << tr("%1 structures").arg(structures);
  }
  return lines.join('\n');
}

QString detailWords(const CaseEntry& entry) {
  if (entry.problem) return toQt(entry.problem->sentence());
  const CaseRecord& record = entry.record;
  QStringList lines{regionWords(record.region) + '.', sizeWords(record.grid)};
  if (!entry.exercise.empty()) {
    lines.prepend(tr("An exercise that was imported, with the case that it is made on."));
  }
  const QDateTime imported = QDateTime::fromString(toQt(record.imported), Qt::ISODate);
  if (imported.isValid()) {
    lines << tr("Imported %1").arg(QLocale().toString(imported, QLocale::ShortFormat));
  }
  if (record.verdict) lines << tr("Import: %1").arg(verdictWord(*record.verdict));
  if (!record.structures.empty()) {
    lines << tr("Structures: %1").arg(structureNames(record.structures, kStructuresNamed));
  }
  if (record.bytes > 0)
    lines << tr("%1 on the disk").arg(megabytes(double(record.bytes) / 1048576.0));
  return lines.join('\n');
}

QString caseWords(const Case& of) {
  QString about = sizeWords(of.volume->geometry);
  if (!of.name.empty()) about = toQt(of.name) + '\n' + about;
  if (of.anatomy) {
    const bool open_vault = of.anatomy->region == BodyRegion::head && !of.anatomy->vault;
    about += '\n' +
             (open_vault ? tr("A head whose vault is not whole") : regionWords(of.anatomy->region));
  }
  if (of.structures && !of.structures->structures.empty()) {
    about += '\n' + tr("with %1").arg(structureNames(of.structures->structures, kStructuresNamed));
  }
  return about;
}

std::vector<CaseEntry> listCases(const CaseLibrary& library, const std::filesystem::path& storage) {
  std::vector<CaseEntry> entries;
  for (const ListedCase& listed : library.list()) {
    CaseEntry entry;
    entry.id = listed.id;
    entry.record = listed.record;
    entry.problem = listed.problem;
    entry.picture = pictureIn(listed.record.folder / case_folders::kPictureFile);
    entries.push_back(std::move(entry));
  }
  for (const std::filesystem::path& file : exercisesIn(storage)) {
    if (std::optional<CaseEntry> entry = broughtBy(file)) entries.push_back(*std::move(entry));
  }
  for (const std::string& name : phantomNames()) entries.push_back(builtIn(name));
  return entries;
}

}  // namespace trephine
