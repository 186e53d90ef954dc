#include "seed_maker.h"

#include <dcmtk/dcmdata/dcpixel.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>
#include <openjpeg.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "imaging/dicom/ct_writer.h"
#include "imaging/importer.h"

namespace trephine::fuzz {

namespace {

void write(const fs::path& file, const Bytes& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

Seeds::Parts partsOf(const Series& series) {
  Seeds::Parts parts;
  for (const Bytes& bytes : series) parts.emplace_back(kSlice, bytes);
  return parts;
}

}  // namespace

void demand(bool done, const std::string& what) {
  if (done) return;
  std::fprintf(stderr, "fuzz_seeds: cannot %s\n", what.c_str());
  std::exit(1);
}

Bytes read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  demand(in.good(), "read " + file.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

Scratch::Scratch() {
  std::string pattern = (fs::temp_directory_path() / "trephine-seeds-XXXXXX").string();
  demand(::mkdtemp(pattern.data()), "make a temporary folder");
  path = pattern;
}

Scratch::~Scratch() {
  fs::remove_all(path);
}

Seeds::Seeds(fs::path folder) : folder_(std::move(folder)) {
  fs::create_directories(folder_);
}

void Seeds::addAnything(const std::string& name, const Parts& parts, int mode) const {
  Bytes input(1, char(mode));
  for (const auto& [file, bytes] : parts) {
    if (input.size() > 1) input += kNextFile;
    input += char(file);
    input += bytes;
  }
  if (input.size() <= kMostBytes) write(folder_ / name, input);
}

void Seeds::addAnything(const std::string& name, const Series& series) const {
  addAnything(name, partsOf(series));
}

void Seeds::add(const std::string& name, const Parts& parts, int mode) const {
  addAnything(name, parts, mode);
  const Scratch scratch;
  const Bytes input = read(folder_ / name);
  for (const File& file : filesIn(std::string_view(input).substr(1))) {
    write(scratch.path / file.name, Bytes(file.bytes));
  }
  auto ct = CtFolder::scan(scratch.path, Progress());
  ImportRequest request;
  request.answers = mode & kOtherAnswers ? kOther : kAnswers;
  const auto uid = ct.ok() ? ct->bestSeries(request.answers) : std::nullopt;
  demand(uid && ct->read(*uid, request, Progress()).ok(), "import the seed " + name);
}

void Seeds::add(const std::string& name, const Series& series, int mode) const {
  add(name, partsOf(series), mode);
}

Volume ramp(Index3 size) {
  Volume volume;
  volume.geometry.size = size;
  volume.geometry.spacing_mm = {0.5, 0.75, 1.25};
  volume.hu.resize(volume.geometry.voxelCount());
  for (std::size_t n = 0; n < volume.hu.size(); ++n) {
    volume.hu[n] = std::int16_t(int(n * 7 % 3001) - 1000);
  }
  return volume;
}

Series seriesOf(const Volume& volume) {
  const Scratch scratch;
  demand(writeCtSeries(volume, {"Seed", "HEAD"}, scratch.path).ok(), "write a series");
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(scratch.path)) files.push_back(entry.path());
  std::ranges::sort(files);
  Series series;
  for (const fs::path& file : files) series.push_back(read(file));
  return series;
}

Series changed(const Series& series, const Change& change, E_TransferSyntax syntax) {
  const Scratch scratch;
  const fs::path file = scratch.path / "slice";
  Series result;
  for (const Bytes& bytes : series) {
    write(file, bytes);
    DcmFileFormat dicom;
    demand(dicom.loadFile(file.c_str()).good(), "read a slice");
    dicom.loadAllDataIntoMemory();
    DcmDataset& data = *dicom.getDataset();
    OFString uid;
    data.findAndGetOFString(DCM_SOPInstanceUID, uid);
    change(data, int(result.size()));
    if (data.tagExists(DCM_SOPInstanceUID)) {
      data.putAndInsertString(DCM_SOPInstanceUID, uid.c_str());  // lossy encoders take a new one
    }
    const OFCondition saved = dicom.saveFile(file.c_str(), syntax);
    demand(saved.good(), std::string("write a slice: ") + saved.text());
    result.push_back(read(file));
  }
  return result;
}

void put(DcmItem& item, const DcmTagKey& tag, const std::string& value) {
  demand(item.putAndInsertString(tag, value.c_str()).good(), "set an attribute");
}

void putPlace(DcmItem& item, double x_mm, double z_mm) {
  put(item, DCM_ImagePositionPatient, std::to_string(x_mm) + "\\0\\" + std::to_string(z_mm));
}

void narrow(DcmDataset& data, int bits) {
  const Uint16* words = nullptr;
  unsigned long count = 0;
  demand(data.findAndGetUint16Array(DCM_PixelData, words, &count).good(), "read pixels");
  data.putAndInsertUint16(DCM_BitsStored, Uint16(bits));
  data.putAndInsertUint16(DCM_HighBit, Uint16(bits - 1));
  std::vector<Uint16> kept(words, words + count);
  for (Uint16& word : kept) word &= Uint16((1 << bits) - 1);
  if (bits > 8) {
    data.putAndInsertUint16Array(DCM_PixelData, kept.data(), count);
    return;
  }
  const std::vector<Uint8> bytes(kept.begin(), kept.end());
  data.putAndInsertUint16(DCM_BitsAllocated, 8);
  data.putAndInsertUint8Array(DCM_PixelData, bytes.data(), count);
}

void encapsulate(DcmDataset& data, E_TransferSyntax syntax, const Bytes& codestream) {
  auto* item = new DcmPixelItem(DCM_PixelItemTag);
  item->putUint8Array(reinterpret_cast<const Uint8*>(codestream.data()),
                      static_cast<unsigned long>(codestream.size()));
  auto* sequence = new DcmPixelSequence(DCM_PixelSequenceTag);
  sequence->insert(new DcmPixelItem(DCM_PixelItemTag));
  sequence->insert(item);
  auto* pixels = new DcmPixelData(DCM_PixelData);
  pixels->putOriginalRepresentation(syntax, nullptr, sequence);
  demand(data.insert(pixels, OFTrue).good(), "encapsulate a picture");
}

Bytes jpeg2000(DcmDataset& data, bool irreversible, bool jp2) {
  const Uint16* words = nullptr;
  unsigned long count = 0;
  Uint16 columns = 0, rows = 0;
  data.findAndGetUint16Array(DCM_PixelData, words, &count);
  data.findAndGetUint16(DCM_Columns, columns);
  data.findAndGetUint16(DCM_Rows, rows);
  opj_cparameters_t parameters;
  opj_set_default_encoder_parameters(&parameters);
  parameters.numresolution = 3;
  parameters.irreversible = irreversible;
  parameters.tcp_numlayers = 1;
  parameters.cp_disto_alloc = 1;
  opj_image_cmptparm_t component{};
  component.dx = component.dy = 1;
  component.w = columns;
  component.h = rows;
  component.prec = 16;
  opj_image_t* image = opj_image_create(1, &component, OPJ_CLRSPC_GRAY);
  image->x1 = columns;
  image->y1 = rows;
  std::copy_n(words, count, image->comps[0].data);
  const Scratch scratch;
  const fs::path file = scratch.path / "picture";
  opj_stream_t* stream = opj_stream_create_default_file_stream(file.c_str(), OPJ_FALSE);
  opj_codec_t* codec = opj_create_compress(jp2 ? OPJ_CODEC_JP2 : OPJ_CODEC_J2K);
  demand(opj_setup_encoder(codec, &parameters, image) && opj_start_compress(codec, image, stream) &&
             opj_encode(codec, stream) && opj_end_compress(codec, stream),
         "encode JPEG 2000");
  opj_stream_destroy(stream);
  opj_destroy_codec(codec);
  opj_image_destroy(image);
  return read(file);
}

}  // namespace trephine::fuzz
