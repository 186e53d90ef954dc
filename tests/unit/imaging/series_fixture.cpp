#include "series_fixture.h"

#include <zlib.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace trephine::test {

namespace fs = std::filesystem;

Volume rampVolume(Index3 size) {
  Volume volume;
  volume.geometry.size = size;
  volume.geometry.spacing_mm = {0.5, 0.75, 1.25};
  volume.geometry.origin_mm = {-20.0, 10.5, 100.0};
  volume.hu.resize(volume.geometry.voxelCount());
  for (std::size_t n = 0; n < volume.hu.size(); ++n) {
    volume.hu[n] = static_cast<std::int16_t>(int(n * 7 % 3001) - 1000);
  }
  return volume;
}

void writeBytes(const fs::path& file, const std::string& bytes) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << bytes;
}

std::string readBytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string packedBy(Deflate format, const std::string& bytes) {
  constexpr int kLargestWindow = 15, kGzip = 16, kLevel = 6, kMemory = 8;
  z_stream zlib{};
  deflateInit2(&zlib, kLevel, Z_DEFLATED,
               format == Deflate::gzip ? kLargestWindow + kGzip : -kLargestWindow, kMemory,
               Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&zlib, bytes.size()), '\0');
  zlib.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  zlib.avail_in = uInt(bytes.size());
  zlib.next_out = reinterpret_cast<Bytef*>(packed.data());
  zlib.avail_out = uInt(packed.size());
  deflate(&zlib, Z_FINISH);
  packed.resize(zlib.total_out);
  deflateEnd(&zlib);
  return packed;
}

fs::path SeriesFixture::slice(int number) const {
  char name[32];
  std::snprintf(name, sizeof name, "IM%04d.dcm", number);
  return folder() / name;
}

void SeriesFixture::write(const Volume& volume) {
  const Status written = writeCtSeries(volume, {"Test series", "HEAD"}, folder());
  ASSERT_TRUE(written.ok()) << written.error().sentence();
}

void SeriesFixture::add(DcmDataset data, const Packing& packing) {
  // Neither the order in which files are made nor their names' order is that of the slices.
  ++added_;
  save(data, folder() / (std::to_string(added_ * 7919 % 1000) + "_" + std::to_string(added_)),
       packing);
}

void SeriesFixture::edit(const fs::path& file, const Change& change, E_TransferSyntax syntax) {
  DcmFileFormat dicom;
  ASSERT_TRUE(dicom.loadFile(file.c_str()).good());
  dicom.loadAllDataIntoMemory();
  change(*dicom.getDataset());
  ASSERT_TRUE(dicom.saveFile(file.c_str(), syntax).good());
}

void SeriesFixture::editAll(const Change& change, E_TransferSyntax syntax) {
  for (const auto& entry : fs::directory_iterator(folder())) edit(entry.path(), change, syntax);
}

void SeriesFixture::again(int number, const Change& change) {
  const fs::path copy = folder() / ("again-" + std::to_string(number));
  fs::copy_file(slice(number), copy);
  edit(copy, [&](DcmDataset& data) {
    put(data, DCM_SOPInstanceUID, "1.2.3." + std::to_string(number));
    change(data);
  });
}

std::string SeriesFixture::text(DcmDataset& data, const DcmTagKey& tag) {
  OFString value;
  data.findAndGetOFStringArray(tag, value);
  return value.c_str();
}

void SeriesFixture::put(DcmDataset& data, const DcmTagKey& tag, const std::string& value) {
  ASSERT_TRUE(data.putAndInsertString(tag, value.c_str()).good());
}

CtFolder SeriesFixture::scan(const fs::path& path) {
  auto result = CtFolder::scan(path, Progress());
  EXPECT_TRUE(result.ok()) << result.error().sentence();
  return std::move(result).value();
}

Volume SeriesFixture::import(const Answers& answers) {
  CtFolder ct = scan();
  const auto best = ct.bestSeries(answers);
  report_ = ct.report();
  if (!best) {
    throw std::runtime_error("no series: " + (report_.error ? report_.error->sentence() : ""));
  }
  ImportRequest request;
  request.answers = answers;
  auto volume = ct.read(*best, request, Progress());
  report_ = ct.report();
  if (!volume.ok()) throw std::runtime_error(volume.error().sentence());
  return std::move(volume).value();
}

Error SeriesFixture::refusal(const Answers& answers) {
  CtFolder ct = scan();
  report_ = ct.report();
  EXPECT_EQ(report_.series.size(), 1U);
  if (report_.series.empty()) return {};
  ImportRequest request;
  request.answers = answers;
  const auto volume = ct.read(report_.series.front().uid, request, Progress());
  report_ = ct.report();
  EXPECT_FALSE(volume.ok());
  return volume.ok() ? Error{} : volume.error();
}

const SeriesReport& SeriesFixture::chosen() const {
  static const SeriesReport none;
  const auto it =
      std::ranges::find(report_.series, report_.chosen.value_or(""), &SeriesReport::uid);
  if (it != report_.series.end()) return *it;
  ADD_FAILURE() << "no series was chosen";
  return none;
}

const Finding* SeriesFixture::find(const SeriesReport& series, const std::string& code) {
  const auto it = std::ranges::find(series.findings, Code::named(code), &Finding::code);
  return it == series.findings.end() ? nullptr : &*it;
}

std::string SeriesFixture::codes(const SeriesReport& series) {
  std::string all;
  for (const Finding& finding : series.findings) all += finding.code.str() + " ";
  return all;
}

Finding SeriesFixture::expectRefused(const std::string& code) {
  CtFolder ct = scan();
  report_ = ct.report();
  EXPECT_EQ(report_.series.size(), 1U);
  if (report_.series.empty()) return {};
  const SeriesReport series = report_.series.front();
  EXPECT_EQ(series.verdict, Verdict::refused);
  EXPECT_FALSE(ct.bestSeries().has_value());
  EXPECT_FALSE(ct.read(series.uid, {}, Progress()).ok());
  EXPECT_FALSE(ct.report().chosen.has_value());
  const Finding* finding = find(series, code);
  EXPECT_NE(finding, nullptr) << "found only: " << codes(series);
  if (!finding) return {};
  EXPECT_EQ(finding->severity, Severity::refusal);
  EXPECT_FALSE(finding->text.empty());
  EXPECT_FALSE(finding->action.empty());
  return *finding;
}

}  // namespace trephine::test
