// Small CT series on disk, and ways to spoil them.
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>

#include "dicom_maker.h"
#include "imaging/dicom/ct_writer.h"
#include "imaging/importer.h"
#include "support.h"

namespace trephine::test {

// Every voxel differs from its neighbours, so that no swap of axes or slices goes unseen.
Volume rampVolume(Index3 size = {7, 5, 6});

void writeBytes(const std::filesystem::path& file, const std::string& bytes);
std::string readBytes(const std::filesystem::path& file);

// By zlib: in gzip's format, or as bare deflated bytes.
enum class Deflate { gzip, bare };
std::string packedBy(Deflate format, const std::string& bytes);

class SeriesFixture : public ::testing::Test {
 protected:
  std::filesystem::path folder() const { return temporary_ / "ct"; }
  std::filesystem::path slice(int number) const;  // as written, from 1

  void write(const Volume& volume);
  // One more file in the folder, under a name that says nothing.
  void add(DcmDataset data, const Packing& packing = {});

  using Change = std::function<void(DcmDataset&)>;
  void edit(const std::filesystem::path& file, const Change& change,
            E_TransferSyntax syntax = EXS_LittleEndianExplicit);
  void editAll(const Change& change, E_TransferSyntax syntax = EXS_LittleEndianExplicit);
  // One more slice at the place of the one as written: a copy under another name and UID, changed.
  void again(int number, const Change& change);
  static std::string text(DcmDataset& data, const DcmTagKey& tag);
  static void put(DcmDataset& data, const DcmTagKey& tag, const std::string& value);

  CtFolder scan() { return scan(folder()); }
  CtFolder scan(const std::filesystem::path& path);
  // Reads the default series; the report is left in `report_`. Throws where none can be read, which
  // fails the test.
  Volume import(const Answers& answers = {});
  // Why read() refuses the one series under these answers.
  Error refusal(const Answers& answers = {});
  const SeriesReport& chosen() const;

  static const Finding* find(const SeriesReport& series, const std::string& code);
  static std::string codes(const SeriesReport& series);
  // Expects one series, refused with this code among its findings and by read() too.
  Finding expectRefused(const std::string& code);

  TemporaryFolder temporary_;
  ImportReport report_;
  int added_ = 0;
};

}  // namespace trephine::test
