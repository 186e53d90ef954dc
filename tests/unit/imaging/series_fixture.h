// Small CT series on disk, and ways to spoil them.
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "imaging/ct_writer.h"
#include "imaging/importer.h"
#include "support.h"

namespace trephine::test {

// Every voxel differs from its neighbours, so that no swap of axes or slices goes unseen.
inline Volume rampVolume(Index3 size = {7, 5, 6}) {
  Volume volume;
  volume.geometry.size = size;
  volume.geometry.spacing_mm = {0.5, 0.75, 1.25};
  volume.geometry.origin_mm = {-20.0, 10.5, 100.0};
  volume.hu.resize(volume.geometry.voxelCount());
  for (std::size_t n = 0; n < volume.hu.size(); ++n)
    volume.hu[n] = std::int16_t(n * 7 % 3001) - 1000;
  return volume;
}

class SeriesFixture : public ::testing::Test {
 protected:
  std::filesystem::path folder() const { return temporary_ / "ct"; }
  std::filesystem::path slice(int number) const {
    char name[32];
    std::snprintf(name, sizeof name, "IM%04d.dcm", number);
    return folder() / name;
  }

  void write(const Volume& volume) {
    const Status written = writeCtSeries(volume, {"Test series", "HEAD"}, folder());
    ASSERT_TRUE(written.ok()) << written.error().sentence();
  }

  void edit(const std::filesystem::path& file, const std::function<void(DcmDataset&)>& change,
            E_TransferSyntax syntax = EXS_LittleEndianExplicit) {
    DcmFileFormat dicom;
    ASSERT_TRUE(dicom.loadFile(file.c_str()).good());
    dicom.loadAllDataIntoMemory();
    change(*dicom.getDataset());
    ASSERT_TRUE(dicom.saveFile(file.c_str(), syntax).good());
  }
  void editAll(const std::function<void(DcmDataset&)>& change,
               E_TransferSyntax syntax = EXS_LittleEndianExplicit) {
    for (const auto& entry : std::filesystem::directory_iterator(folder())) {
      edit(entry.path(), change, syntax);
    }
  }

  static std::string text(DcmDataset& data, const DcmTagKey& tag) {
    OFString value;
    data.findAndGetOFStringArray(tag, value);
    return value.c_str();
  }
  static void put(DcmDataset& data, const DcmTagKey& tag, const std::string& value) {
    ASSERT_TRUE(data.putAndInsertString(tag, value.c_str()).good());
  }

  CtFolder scan() { return scan(folder()); }
  CtFolder scan(const std::filesystem::path& path) {
    auto result = CtFolder::scan(path, Progress());
    EXPECT_TRUE(result.ok()) << result.error().sentence();
    return std::move(result).value();
  }
  // Reads the default series; the report is left in `report_`.
  Volume import() {
    CtFolder ct = scan();
    const auto best = ct.bestSeries();
    report_ = ct.report();
    if (!best) {
      ADD_FAILURE() << "no series: " << (report_.error ? report_.error->sentence() : "");
      return {};
    }
    auto volume = ct.read(*best, Progress());
    report_ = ct.report();
    if (!volume.ok()) {
      ADD_FAILURE() << volume.error().sentence();
      return {};
    }
    return std::move(volume).value();
  }
  const SeriesReport& chosen() const {
    return *std::ranges::find(report_.series, report_.chosen.value_or(""), &SeriesReport::uid);
  }

  static const Finding* find(const SeriesReport& series, const std::string& code) {
    const auto it = std::ranges::find(series.findings, code, &Finding::code);
    return it == series.findings.end() ? nullptr : &*it;
  }
  static std::string codes(const SeriesReport& series) {
    std::string all;
    for (const Finding& finding : series.findings) all += finding.code + " ";
    return all;
  }
  // Expects one series, refused with this code among its findings and by read() too.
  Finding expectRefused(const std::string& code) {
    CtFolder ct = scan();
    report_ = ct.report();
    EXPECT_EQ(report_.series.size(), 1u);
    if (report_.series.empty()) return {};
    const SeriesReport series = report_.series.front();
    EXPECT_EQ(series.verdict, Verdict::refused);
    EXPECT_FALSE(ct.bestSeries().has_value());
    EXPECT_FALSE(ct.read(series.uid, Progress()).ok());
    EXPECT_FALSE(ct.report().chosen.has_value());
    const Finding* finding = find(series, code);
    EXPECT_NE(finding, nullptr) << "found only: " << codes(series);
    if (!finding) return {};
    EXPECT_EQ(finding->severity, "refusal");
    EXPECT_FALSE(finding->text.empty());
    EXPECT_FALSE(finding->action.empty());
    return *finding;
  }

  TemporaryFolder temporary_;
  ImportReport report_;
};

inline void writeBytes(const std::filesystem::path& file, const std::string& bytes) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << bytes;
}
inline std::string readBytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace trephine::test
