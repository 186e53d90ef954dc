#include "dicom_maker.h"

#include <dcmtk/dcmdata/dcpixel.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>
#include <dcmtk/dcmdata/dcrleerg.h>
#include <dcmtk/dcmdata/dcrlerp.h>
#include <dcmtk/dcmjpeg/djencode.h>
#include <dcmtk/dcmjpeg/djrplol.h>
#include <dcmtk/dcmjpeg/djrploss.h>
#include <dcmtk/dcmjpls/djencode.h>
#include <dcmtk/dcmjpls/djrparam.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <memory>

namespace trephine::test {

namespace {

void put(DcmItem& item, const DcmTagKey& tag, const std::string& value) {
  ASSERT_TRUE(item.putAndInsertString(tag, value.c_str()).good()) << tag.toString();
}

void put16(DcmItem& item, const DcmTagKey& tag, int value) {
  ASSERT_TRUE(item.putAndInsertUint16(tag, Uint16(value)).good()) << tag.toString();
}

std::string join(const std::vector<std::string>& values) {
  std::string text;
  for (const std::string& value : values) text += (text.empty() ? "" : "\\") + value;
  return text;
}

std::string orientationText(const Image& image) {
  std::vector<std::string> cosines;
  for (const double c : image.orientation) cosines.push_back(decimalText(c));
  return join(cosines);
}

std::string spacingText(const Image& image) {
  return join({decimalText(image.spacing_mm[0]), decimalText(image.spacing_mm[1])});
}

void putPixels(DcmDataset& data, const Image& image) {
  const int mask = (1 << image.bits_stored) - 1;
  const int up = image.high_bit + 1 - image.bits_stored;
  std::vector<Uint8> bytes;
  std::vector<Uint16> words;
  for (const int value : image.stored) {
    words.push_back(Uint16((value & mask) << up));
    bytes.push_back(Uint8(words.back()));
  }
  if (image.bits_allocated == 8) {
    if (bytes.size() % 2) bytes.push_back(0);
    ASSERT_TRUE(data.putAndInsertUint8Array(DCM_PixelData, bytes.data(), bytes.size()).good());
  } else {
    ASSERT_TRUE(data.putAndInsertUint16Array(DCM_PixelData, words.data(), words.size()).good());
  }
}

void putCommon(DcmDataset& data, const Image& image) {
  put(data, DCM_SOPInstanceUID, "1.2.3.4." + std::to_string(image.instance));
  put(data, DCM_StudyInstanceUID, "1.2.3");
  put(data, DCM_SeriesInstanceUID, "1.2.3.4");
  put(data, DCM_FrameOfReferenceUID, "1.2.3.5");
  put(data, DCM_Modality, "CT");
  put(data, DCM_InstanceNumber, std::to_string(image.instance));
  put16(data, DCM_SamplesPerPixel, 1);
  put(data, DCM_PhotometricInterpretation, "MONOCHROME2");
  put16(data, DCM_Rows, image.rows);
  put16(data, DCM_Columns, image.columns);
  put16(data, DCM_BitsAllocated, image.bits_allocated);
  put16(data, DCM_BitsStored, image.bits_stored);
  put16(data, DCM_HighBit, image.high_bit);
  put16(data, DCM_PixelRepresentation, image.is_signed);
}

void registerEncoders() {
  static const bool done = [] {
    DcmRLEEncoderRegistration::registerCodecs();
    DJEncoderRegistration::registerCodecs();
    DJLSEncoderRegistration::registerCodecs(0, 0, 0, 0, OFFalse);
    return true;
  }();
  ASSERT_TRUE(done);
}

int number(DcmDataset& data, const DcmTagKey& tag, int fallback) {
  OFString text;
  if (data.findAndGetOFString(tag, text).bad() || text.empty()) return fallback;
  return std::stoi(text.c_str());
}

// The bytes of one frame, as 8- or 16-bit values in native order.
std::vector<Uint8> frameBytes(DcmDataset& data, int frame) {
  const auto bytes = std::size_t(number(data, DCM_Rows, 0)) *
                     std::size_t(number(data, DCM_Columns, 0)) *
                     std::size_t(number(data, DCM_BitsAllocated, 0) / 8);
  const Uint8* narrow = nullptr;
  const Uint16* wide = nullptr;
  if (number(data, DCM_BitsAllocated, 0) == 8) {
    EXPECT_TRUE(data.findAndGetUint8Array(DCM_PixelData, narrow).good());
  } else {
    EXPECT_TRUE(data.findAndGetUint16Array(DCM_PixelData, wide).good());
    narrow = reinterpret_cast<const Uint8*>(wide);
  }
  return {narrow + bytes * std::size_t(frame), narrow + bytes * std::size_t(frame + 1)};
}

Bytes encodeJpeg2000(DcmDataset& data, int frame, const Packing& packing) {
  Picture picture{number(data, DCM_Columns, 0), number(data, DCM_Rows, 0),
                  number(data, DCM_BitsStored, 0), number(data, DCM_PixelRepresentation, 0) == 1};
  const std::vector<Uint8> bytes = frameBytes(data, frame);
  const bool wide = number(data, DCM_BitsAllocated, 0) == 16;
  const int shift = number(data, DCM_HighBit, 0) + 1 - picture.bits;
  for (std::size_t n = 0; n < bytes.size(); n += wide ? 2 : 1) {
    const int word = bytes[n] | (wide ? bytes[n + 1] << 8 : 0);
    int value = (word >> shift) & ((1 << picture.bits) - 1);
    if (picture.is_signed && value >> (picture.bits - 1)) value -= 1 << picture.bits;
    picture.samples.push_back(value);
  }
  Coding coding;
  coding.irreversible = packing.irreversible;
  return encode(picture, coding);
}

Bytes encodeWithDcmtk(DcmDataset& data, int frame, const Packing& packing) {
  registerEncoders();
  DcmDataset one(data);
  put(one, DCM_NumberOfFrames, "1");
  std::vector<Uint8> bytes = frameBytes(data, frame);
  if (number(data, DCM_BitsAllocated, 0) == 8) {
    if (bytes.size() % 2) bytes.push_back(0);
    one.putAndInsertUint8Array(DCM_PixelData, bytes.data(), bytes.size());
  } else {
    one.putAndInsertUint16Array(DCM_PixelData, reinterpret_cast<const Uint16*>(bytes.data()),
                                bytes.size() / 2);
  }
  std::unique_ptr<DcmRepresentationParameter> parameter;
  if (packing.syntax == EXS_RLELossless) {
    parameter = std::make_unique<DcmRLERepresentationParameter>();
  } else if (packing.syntax == EXS_JPEGLSLossless || packing.syntax == EXS_JPEGLSLossy) {
    const bool lossless = packing.syntax == EXS_JPEGLSLossless;
    parameter = std::make_unique<DJLSRepresentationParameter>(Uint16(packing.near_by), lossless);
  } else if (packing.syntax == EXS_JPEGProcess14 || packing.syntax == EXS_JPEGProcess14SV1) {
    parameter = std::make_unique<DJ_RPLossless>(packing.predictor, 0);
  } else {
    parameter = std::make_unique<DJ_RPLossy>(100);
  }
  const OFCondition encoded = one.chooseRepresentation(packing.syntax, parameter.get());
  EXPECT_TRUE(encoded.good()) << encoded.text();
  DcmElement* element = nullptr;
  EXPECT_TRUE(one.findAndGetElement(DCM_PixelData, element).good());
  DcmPixelSequence* items = nullptr;
  E_TransferSyntax syntax = EXS_Unknown;
  const DcmRepresentationParameter* used = nullptr;
  auto& pixels = dynamic_cast<DcmPixelData&>(*element);
  pixels.getCurrentRepresentationKey(syntax, used);
  if (pixels.getEncapsulatedRepresentation(syntax, used, items).bad()) {
    ADD_FAILURE() << "nothing was encoded";
    return {};
  }
  Bytes codestream;
  for (unsigned long n = 1; n < items->card(); ++n) {  // 0 is the offset table
    DcmPixelItem* item = nullptr;
    Uint8* part = nullptr;
    items->getItem(item, n);
    item->getUint8Array(part);
    codestream.insert(codestream.end(), part, part + item->getLength());
  }
  return codestream;
}

}  // namespace

int patternValue(int i, int j, int k, int bits, bool is_signed) {
  const int value = (i * 131 + j * 517 + k * 1009 + (i * j * k) % 97) & ((1 << bits) - 1);
  return is_signed ? value - (1 << (bits - 1)) : value;
}

void fillPattern(Image& image, int k) {
  image.stored.clear();
  for (int frame = 0; frame < image.frames; ++frame) {
    for (int j = 0; j < image.rows; ++j) {
      for (int i = 0; i < image.columns; ++i) {
        image.stored.push_back(patternValue(i, j, k + frame, image.bits_stored, image.is_signed));
      }
    }
  }
}

std::string decimalText(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

std::string positionText(const Vec3& p) {
  return join({decimalText(p.x), decimalText(p.y), decimalText(p.z)});
}

DcmDataset makeImage(const Image& image) {
  DcmDataset data;
  put(data, DCM_SOPClassUID, UID_CTImageStorage);
  putCommon(data, image);
  put(data, DCM_ImagePositionPatient, positionText(image.position_mm));
  put(data, DCM_ImageOrientationPatient, orientationText(image));
  put(data, DCM_PixelSpacing, spacingText(image));
  if (!image.slope.empty()) put(data, DCM_RescaleSlope, image.slope);
  if (!image.intercept.empty()) put(data, DCM_RescaleIntercept, image.intercept);
  if (image.frames > 1) put(data, DCM_NumberOfFrames, std::to_string(image.frames));
  putPixels(data, image);
  return data;
}

DcmItem& functionalGroup(DcmDataset& data, const DcmTagKey& macro, int frame) {
  const DcmTagKey sequence =
      frame < 0 ? DCM_SharedFunctionalGroupsSequence : DCM_PerFrameFunctionalGroupsSequence;
  DcmItem *group = nullptr, *item = nullptr;
  EXPECT_TRUE(data.findOrCreateSequenceItem(sequence, group, std::max(frame, 0)).good());
  EXPECT_TRUE(group->findOrCreateSequenceItem(macro, item, 0).good());
  return *item;
}

DcmDataset makeEnhanced(const Image& image, const std::vector<Vec3>& positions_mm) {
  DcmDataset data;
  put(data, DCM_SOPClassUID, UID_EnhancedCTImageStorage);
  putCommon(data, image);
  put(data, DCM_NumberOfFrames, std::to_string(image.frames));
  put(functionalGroup(data, DCM_PixelMeasuresSequence, -1), DCM_PixelSpacing, spacingText(image));
  put(functionalGroup(data, DCM_PlaneOrientationSequence, -1), DCM_ImageOrientationPatient,
      orientationText(image));
  DcmItem& rescale = functionalGroup(data, DCM_PixelValueTransformationSequence, -1);
  put(rescale, DCM_RescaleSlope, image.slope);
  put(rescale, DCM_RescaleIntercept, image.intercept);
  for (std::size_t n = 0; n < positions_mm.size(); ++n) {
    put(functionalGroup(data, DCM_PlanePositionSequence, int(n)), DCM_ImagePositionPatient,
        positionText(positions_mm[n]));
  }
  putPixels(data, image);
  return data;
}

bool isEncapsulated(E_TransferSyntax syntax) {
  return DcmXfer(syntax).isEncapsulated();
}

std::vector<Bytes> encodeFrames(DcmDataset& data, const Packing& packing) {
  const bool jpeg2000 =
      packing.syntax == EXS_JPEG2000 || packing.syntax == EXS_JPEG2000LosslessOnly;
  std::vector<Bytes> codestreams;
  for (int frame = 0; frame < number(data, DCM_NumberOfFrames, 1); ++frame) {
    codestreams.push_back(jpeg2000 ? encodeJpeg2000(data, frame, packing)
                                   : encodeWithDcmtk(data, frame, packing));
    if (codestreams.back().size() % 2) codestreams.back().push_back(0);
  }
  return codestreams;
}

void saveEncapsulated(DcmDataset& data, const std::vector<Bytes>& codestreams,
                      const Packing& packing, const std::filesystem::path& file) {
  auto* sequence = new DcmPixelSequence(DCM_PixelSequenceTag);  // owned by `pixels`
  auto* table = new DcmPixelItem(DCM_PixelItemTag);
  sequence->insert(table);
  std::vector<Uint32> offsets;
  Uint32 offset = 0;
  for (const Bytes& codestream : codestreams) {
    offsets.push_back(offset);
    const std::size_t part = (codestream.size() / std::size_t(packing.fragments) + 1) / 2 * 2;
    for (int n = 0; n < packing.fragments; ++n) {
      const std::size_t from = part * std::size_t(n);
      const std::size_t to = n + 1 == packing.fragments ? codestream.size() : from + part;
      auto* item = new DcmPixelItem(DCM_PixelItemTag);
      item->putUint8Array(codestream.data() + from, static_cast<unsigned long>(to - from));
      sequence->insert(item);
      offset += 8 + Uint32(to - from);
    }
  }
  if (packing.offset_table) {
    table->putUint8Array(reinterpret_cast<const Uint8*>(offsets.data()),
                         static_cast<unsigned long>(offsets.size() * sizeof(Uint32)));
  }
  const E_TransferSyntax syntax = packing.called == EXS_Unknown ? packing.syntax : packing.called;
  auto* pixels = new DcmPixelData(DCM_PixelData);  // owned by the file
  pixels->putOriginalRepresentation(syntax, nullptr, sequence);
  DcmFileFormat dicom(&data);
  dicom.getDataset()->insert(pixels, OFTrue);
  std::filesystem::create_directories(file.parent_path());
  const OFCondition saved = dicom.saveFile(file.c_str(), syntax);
  ASSERT_TRUE(saved.good()) << saved.text();
}

void save(DcmDataset& data, const std::filesystem::path& file, const Packing& packing) {
  if (isEncapsulated(packing.syntax)) {
    saveEncapsulated(data, encodeFrames(data, packing), packing, file);
    return;
  }
  std::filesystem::create_directories(file.parent_path());
  DcmFileFormat dicom(&data);
  const OFCondition saved = dicom.saveFile(file.c_str(), packing.syntax);
  ASSERT_TRUE(saved.good()) << saved.text();
}

}  // namespace trephine::test
