// What fuzz_seeds makes its examples with: inputs written into a folder, and tiny DICOM series made
// in memory. What cannot be done ends the program with a sentence.
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "framing.h"
#include "volume/volume.h"

namespace trephine::fuzz {

namespace fs = std::filesystem;
using Bytes = std::string;
using Series = std::vector<Bytes>;  // a file a slice

constexpr std::uintmax_t kMostBytes = 65536;  // of one seed: the fuzzer's -max_len

void demand(bool done, const std::string& what);
Bytes read(const fs::path& file);

// A folder for files on their way through libraries that write nothing else.
struct Scratch {
  Scratch();
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  fs::path path;
};

class Seeds {
 public:
  explicit Seeds(fs::path folder);

  using Parts = std::vector<std::pair<Name, Bytes>>;
  // Whatever comes of it.
  void addAnything(const std::string& name, const Parts& parts, int mode = 0) const;
  void addAnything(const std::string& name, const Series& series) const;
  // One of which a volume comes, so that what is made of it reaches codecs and assembly too.
  void add(const std::string& name, const Parts& parts, int mode = 0) const;
  void add(const std::string& name, const Series& series, int mode = 0) const;

 private:
  fs::path folder_;
};

Volume ramp(Index3 size);
Series seriesOf(const Volume& volume);

// `change` gets the data set and the slice's number from 0.
using Change = std::function<void(DcmDataset&, int)>;
Series changed(const Series& series, const Change& change,
               E_TransferSyntax syntax = EXS_LittleEndianExplicit);

void put(DcmItem& item, const DcmTagKey& tag, const std::string& value);
void putPlace(DcmItem& item, double x_mm, double z_mm);
// Fewer bits, as some codecs need.
void narrow(DcmDataset& data, int bits);
void encapsulate(DcmDataset& data, E_TransferSyntax syntax, const Bytes& codestream);
Bytes jpeg2000(DcmDataset& data, bool irreversible, bool jp2);

}  // namespace trephine::fuzz
