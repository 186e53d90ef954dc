// Any bytes as a folder of files, through all that the importer does. See README.md.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "framing.h"
#include "imaging/importer.h"
#include "imaging/report/provenance.h"
#include "imaging/report/report_page.h"
#include "processor_time.h"

namespace trephine::fuzz {

namespace {

namespace fs = std::filesystem;

constexpr double kMostMemory_mb = 256.0;
// What a slice may have to be decoded here: the importer takes 8192 x 8192, which under sanitizers
// takes longer than kMostSeconds.
constexpr std::uint64_t kMostPixels = std::uint64_t(2048) * 2048;
// Processor time; -timeout bounds the time by the clock.
constexpr double kMostSeconds = 5.0;

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz_import: %s\n", what);
  std::abort();
}

// One folder for all inputs of this process.
class Folder {
 public:
  Folder() {
    std::string pattern = (fs::temp_directory_path() / "trephine-fuzz-XXXXXX").string();
    require(::mkdtemp(pattern.data()), "no temporary folder can be made");
    path_ = pattern;
  }
  ~Folder() { clear(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  fs::path fill(const std::vector<File>& files) const {
    const fs::path folder = path_ / "in";
    clear(folder);
    fs::create_directory(folder);
    for (const File& file : files) {
      std::ofstream out(folder / file.name, std::ios::binary);
      out.write(file.bytes.data(), std::streamsize(file.bytes.size()));
      require(out.good(), "the temporary folder is full");
    }
    return folder;
  }

 private:
  static void clear(const fs::path& folder) {
    std::error_code error;
    fs::remove_all(folder, error);
  }
  fs::path path_;
};

void checkReport(const ImportReport& report) {
  toJson(report).dump();  // throws where a text is no UTF-8
  reportPage(report);
  if (report.provenance) toJson(*report.provenance).dump();
}

void checkSlice(const CtFolder& folder, const SeriesReport& series, int index) {
  const auto picture = folder.slice(series.uid, index);
  if (!picture.ok()) return require(!picture.error().what.empty(), "an error says nothing");
  require(picture->hu.size() == std::size_t(picture->columns) * std::size_t(picture->rows),
          "a slice's size is not that of its pixels");
}

void checkRead(CtFolder& folder, const std::string& uid, const ImportRequest& request) {
  const auto volume = folder.read(uid, request, Progress());
  checkReport(folder.report());
  if (!volume.ok()) return require(!volume.error().what.empty(), "an error says nothing");
  require(volume->hu.size() == volume->geometry.voxelCount(),
          "a volume's size is not that of its voxels");
  require(folder.report().chosen == uid, "the series that was read is not the chosen one");
}

void import(const fs::path& path, std::uint8_t mode) {
  auto scanned = CtFolder::scan(path, Progress());
  if (!scanned.ok()) return require(!scanned.error().what.empty(), "an error says nothing");
  CtFolder& folder = *scanned;
  checkReport(folder.report());
  folder.bestSeries();

  ImportRequest request;
  request.most_memory_mb = kMostMemory_mb;
  ImportRequest answered = request;
  answered.answers = mode & kOtherAnswers ? kOther : kAnswers;
  if (mode & kReduce) answered.reduction = 2;
  if (mode & kCrop) answered.crop = VoxelBox{{0, 0, 0}, {3, 3, 2}};
  folder.bestSeries(answered.answers);

  const std::vector<SeriesReport> listed = folder.report().series;
  for (const SeriesReport& series : listed) {
    const Index3& size = series.geometry.size;
    if (std::uint64_t(size[0]) * std::uint64_t(size[1]) > kMostPixels) continue;
    for (int index = 0; index <= std::min(series.slices, 3); ++index) {
      checkSlice(folder, series, index);
    }
    checkRead(folder, series.uid, request);
    checkRead(folder, series.uid, answered);
  }
}

}  // namespace

}  // namespace trephine::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trephine::fuzz;
  static const Folder folder;
  if (size < 2) return 0;
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const std::vector<File> files = filesIn(input.substr(1));
  if (files.empty()) return 0;
  const double start = processorSeconds();
  const std::filesystem::path path = folder.fill(files);
  import(data[0] & kOpenFirstFile ? path / files.front().name : path, data[0]);
  require(processorSeconds() - start <= kMostSeconds, "an input takes over 5 s of processor time");
  return 0;
}
