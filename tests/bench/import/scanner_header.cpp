#include "bench/import/scanner_header.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <string>
#include <vector>

#include "bench/import/noisy_ct.h"

namespace trephine::bench {

namespace {

struct Element {
  Uint16 group, element;
  DcmEVR vr;
  const char* value;
};

// What every slice says alike. The private groups are this program's own.
constexpr Element kElements[] = {
    {0x0008, 0x0008, EVR_CS, "ORIGINAL\\PRIMARY\\AXIAL\\HELIX"},
    {0x0008, 0x0012, EVR_DA, "20260105"},
    {0x0008, 0x0013, EVR_TM, "101530.000"},
    {0x0008, 0x0020, EVR_DA, "20260105"},
    {0x0008, 0x0021, EVR_DA, "20260105"},
    {0x0008, 0x0022, EVR_DA, "20260105"},
    {0x0008, 0x0023, EVR_DA, "20260105"},
    {0x0008, 0x002a, EVR_DT, "20260105101512.250"},
    {0x0008, 0x0030, EVR_TM, "101430.125"},
    {0x0008, 0x0031, EVR_TM, "101510.500"},
    {0x0008, 0x0032, EVR_TM, "101512.250"},
    {0x0008, 0x0033, EVR_TM, "101529.750"},
    {0x0008, 0x0050, EVR_SH, ""},
    {0x0008, 0x0080, EVR_LO, "None"},
    {0x0008, 0x0090, EVR_PN, ""},
    {0x0008, 0x1010, EVR_SH, "PHANTOM1"},
    {0x0008, 0x1030, EVR_LO, "Phantom study"},
    {0x0008, 0x103e, EVR_LO, "Cranium phantom, noisy"},
    {0x0008, 0x1040, EVR_LO, "None"},
    {0x0008, 0x1090, EVR_LO, "Phantom with noise"},
    {0x0010, 0x0030, EVR_DA, ""},
    {0x0010, 0x0040, EVR_CS, "O"},
    {0x0010, 0x1010, EVR_AS, "040Y"},
    {0x0010, 0x1030, EVR_DS, "70"},
    {0x0018, 0x0015, EVR_CS, "HEAD"},
    {0x0018, 0x0022, EVR_CS, "HELICAL MODE"},
    {0x0018, 0x0060, EVR_DS, "120"},
    {0x0018, 0x0090, EVR_DS, "500"},
    {0x0018, 0x1000, EVR_LO, "0"},
    {0x0018, 0x1020, EVR_LO, "1"},
    {0x0018, 0x1030, EVR_LO, "Head thin slices"},
    {0x0018, 0x1100, EVR_DS, "230"},
    {0x0018, 0x1110, EVR_DS, "949.075012"},
    {0x0018, 0x1111, EVR_DS, "541"},
    {0x0018, 0x1120, EVR_DS, "0"},
    {0x0018, 0x1130, EVR_DS, "143.199997"},
    {0x0018, 0x1140, EVR_CS, "CW"},
    {0x0018, 0x1150, EVR_IS, "500"},
    {0x0018, 0x1151, EVR_IS, "220"},
    {0x0018, 0x1152, EVR_IS, "110"},
    {0x0018, 0x1160, EVR_SH, "HEAD FILTER"},
    {0x0018, 0x1170, EVR_IS, "26400"},
    {0x0018, 0x1190, EVR_DS, "0.7"},
    {0x0018, 0x1210, EVR_SH, "STANDARD"},
    {0x0018, 0x5100, EVR_CS, "HFS"},
    {0x0018, 0x9305, EVR_FD, "0.5"},
    {0x0018, 0x9306, EVR_FD, "0.625"},
    {0x0018, 0x9307, EVR_FD, "40"},
    {0x0018, 0x9309, EVR_FD, "41.25"},
    {0x0018, 0x9310, EVR_FD, "20.625"},
    {0x0018, 0x9311, EVR_FD, "0.515625"},
    {0x0018, 0x9345, EVR_FD, "22.5"},
    {0x0020, 0x000d, EVR_UI, "2.25.1"},  // one study for all
    {0x0020, 0x0010, EVR_SH, "1"},
    {0x0020, 0x0012, EVR_IS, "1"},
    {0x0020, 0x0052, EVR_UI, "2.25.2"},
    {0x0020, 0x1040, EVR_LO, "OM"},
    {0x0020, 0x4000, EVR_LT, "For training, not for diagnosis"},
    {0x0028, 0x1050, EVR_DS, "40\\700"},
    {0x0028, 0x1051, EVR_DS, "90\\3200"},
    {0x0028, 0x1055, EVR_LO, "BRAIN\\BONE"},
    {0x0009, 0x0010, EVR_LO, "TREPHINE SOURCE"},
    {0x0009, 0x1001, EVR_LO, "phantom"},
    {0x0009, 0x1002, EVR_SH, "cranium"},
    {0x0009, 0x1027, EVR_SL, "1767608130"},
    {0x0009, 0x10e3, EVR_UI, "2.25.1"},
    {0x0019, 0x0010, EVR_LO, "TREPHINE TUBE"},
    {0x0019, 0x1002, EVR_SL, "912"},
    {0x0019, 0x1003, EVR_DS, "389.75"},
    {0x0019, 0x1004, EVR_DS, "1.0239"},
    {0x0019, 0x100f, EVR_DS, "395.1"},
    {0x0019, 0x1011, EVR_SS, "1"},
    {0x0019, 0x1018, EVR_LO, "S"},
    {0x0019, 0x101a, EVR_LO, "I"},
    {0x0019, 0x1023, EVR_DS, "20.625"},
    {0x0019, 0x1024, EVR_DS, "14.2"},
    {0x0019, 0x1025, EVR_SS, "7"},
    {0x0019, 0x1026, EVR_SL, "0"},
    {0x0019, 0x1027, EVR_DS, "0.5"},
    {0x0019, 0x102c, EVR_SL, "5060"},
    {0x0019, 0x1039, EVR_SS, "4"},
    {0x0019, 0x1042, EVR_SS, "0"},
    {0x0043, 0x0010, EVR_LO, "TREPHINE RECON"},
    {0x0043, 0x1010, EVR_US, "400"},
    {0x0043, 0x1012, EVR_SS, "14\\2\\3"},
    {0x0043, 0x1016, EVR_SS, "2"},
    {0x0043, 0x101a, EVR_SL, "7"},
    {0x0043, 0x1026, EVR_US, "0\\0\\1\\1\\2\\0"},
    {0x0043, 0x1027, EVR_SH, "/0.516:1"},
    {0x0043, 0x1040, EVR_FL, "148.96"},
    {0x0043, 0x1041, EVR_FL, "52.12"},
};

// Keeps the first failure of many calls.
class Filling {
 public:
  explicit Filling(DcmItem& item) : item_(item) {}
  void put(const DcmTag& tag, const std::string& value) {
    if (result_.good()) result_ = item_.putAndInsertString(tag, value.c_str());
  }
  void check(const OFCondition& result) {
    if (result_.good()) result_ = result;
  }
  const OFCondition& result() const { return result_; }

 private:
  DcmItem& item_;
  OFCondition result_ = EC_Normal;
};

// A reference to another object, as sequences hold them.
OFCondition putReference(DcmDataset& data, const DcmTagKey& sequence, const std::string& uid) {
  DcmItem* item = nullptr;
  const OFCondition made = data.findOrCreateSequenceItem(sequence, item, -2);
  if (made.bad()) return made;
  Filling filling(*item);
  filling.put(DCM_ReferencedSOPClassUID, UID_CTImageStorage);
  filling.put(DCM_ReferencedSOPInstanceUID, uid);
  return filling.result();
}

OFCondition putProtocol(DcmDataset& data) {
  DcmItem *request = nullptr, *code = nullptr;
  OFCondition made = data.findOrCreateSequenceItem(DCM_RequestAttributesSequence, request, -2);
  if (made.bad()) return made;
  made = request->findOrCreateSequenceItem(DCM_ScheduledProtocolCodeSequence, code, -2);
  if (made.bad()) return made;
  Filling step(*request), meaning(*code);
  step.put(DCM_ScheduledProcedureStepDescription, "Phantom");
  step.put(DCM_ScheduledProcedureStepID, "1");
  step.put(DCM_RequestedProcedureID, "1");
  meaning.put(DCM_CodeValue, "PHANTOM");
  meaning.put(DCM_CodingSchemeDesignator, "99TREPHINE");
  meaning.put(DCM_CodeMeaning, "Phantom");
  return step.result().bad() ? step.result() : meaning.result();
}

}  // namespace

OFCondition putScannerHeader(DcmDataset& data, int series_number) {
  Filling filling(data);
  for (const Element& e : kElements) filling.put(DcmTag(e.group, e.element, e.vr), e.value);
  OFString z;
  filling.check(data.findAndGetOFString(DCM_ImagePositionPatient, z, 2));
  filling.put(DCM_SliceLocation, z.c_str());
  filling.put(DCM_SeriesNumber, std::to_string(series_number));

  filling.check(putReference(data, DCM_ReferencedImageSequence, "2.25.3"));
  filling.check(putReference(data, DCM_SourceImageSequence, "2.25.4"));
  filling.check(putProtocol(data));
  std::vector<Uint8> block(512);
  for (std::size_t n = 0; n < block.size(); ++n) block[n] = Uint8(hashedNumber(n));
  filling.check(data.putAndInsertUint8Array(DcmTag(0x0043, 0x1029, EVR_OB), block.data(), 512));
  filling.check(data.putAndInsertUint8Array(DcmTag(0x0043, 0x102a, EVR_OB), block.data(), 512));
  return filling.result();
}

}  // namespace trephine::bench
