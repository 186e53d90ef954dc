// Decodes every frame of each file and says what came out: for comparing with other readers.
//
//   decode_slices --out FILE DICOM_FILE...
//
// Appends each frame's HU to FILE as raw little-endian int16 and prints a JSON line for it: "file",
// "series", "index" (along the stack), "columns", "rows", or "error". A file without series gives
// one line with "skipped".
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "base/json.h"
#include "imaging/importer.h"

namespace trephine {

namespace {

void decode(const std::string& file, std::ofstream& out) {
  const auto ct = CtFolder::scan(file, Progress());
  if (!ct.ok()) {
    std::cout << Json{{"file", file}, {"skipped", ct.error().sentence()}}.dump() << "\n";
    return;
  }
  const ImportReport& report = ct->report();
  if (report.series.empty()) {
    const std::string why = report.skipped.empty() ? "" : report.skipped.front().reason;
    std::cout << Json{{"file", file}, {"skipped", why}}.dump() << "\n";
  }
  for (const SeriesReport& series : report.series) {
    for (int index = 0; index < series.slices; ++index) {
      Json line = {{"file", file}, {"series", series.uid}, {"index", index}};
      const auto picture = ct->slice(series.uid, index);
      if (picture.ok()) {
        line["columns"] = picture->columns;
        line["rows"] = picture->rows;
        line["lossy"] = series.lossy;
        out.write(reinterpret_cast<const char*>(picture->hu.data()),
                  std::streamsize(picture->hu.size() * sizeof(std::int16_t)));
      } else {
        line["error"] = picture.error().code.str() + ": " + picture.error().what;
      }
      std::cout << line.dump() << "\n";
    }
  }
}

}  // namespace

}  // namespace trephine

int main(int count, char** arguments) {
  if (count < 4 || std::string(arguments[1]) != "--out") {
    std::cerr << "usage: decode_slices --out FILE DICOM_FILE...\n";
    return 2;
  }
  std::ofstream out(arguments[2], std::ios::binary);
  for (int n = 3; n < count; ++n) trephine::decode(arguments[n], out);
  out.flush();
  return out ? 0 : 1;
}
