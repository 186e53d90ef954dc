// What an import says to a person: states, sentences, sizes. Text from files is plain text here;
// only reportHtml() returns marked-up text, with what came from files escaped.
#pragma once

#include <QColor>
#include <QString>

#include "imaging/importer.h"
#include "imaging/series_state.h"

namespace trephine {

QString stateWord(SeriesState state);
QColor stateColour(SeriesState state);
// "Ready to use. Nothing had to be changed."
QString verdictSentence(const SeriesReport& series, const Answers& answers);

// The description, or words for its lack.
QString seriesName(const SeriesReport& series);
// "CT, 140 slices, 512 x 512"
QString seriesLine(const SeriesReport& series);

// "3.0, 4.0, 5.0 and 17 more"; empty for none.
QString slicesWords(const std::vector<std::string>& slices);
// "850 MB", "1.4 GB", of 2^20 and 2^30 bytes.
QString megabytes(double mb);
// What a case needs of memory against what is free.
QString memoryWords(double needed_mb, double free_mb);
QString lossWords(const MeasuredLoss& loss);
// "512 x 512 x 140 voxels of 0.45 x 0.45 x 1.00 mm", in one line.
QString gridWords(const GridGeometry& geometry);

// Facts and findings of a series for a label.
QString reportHtml(const SeriesReport& series);
// What the folder holds beside its series: files seen, and what was left out and why.
QString folderWords(const ImportReport& report);

}  // namespace trephine
