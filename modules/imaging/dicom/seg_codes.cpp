#include "imaging/dicom/detail/seg_codes.h"

#include <algorithm>
#include <string_view>
#include <vector>

namespace trephine {

namespace {

constexpr SegmentCode kAnatomical{"123037004", "Anatomical Structure"};
constexpr SegmentCode kTissue{"85756007", "Tissue"};
constexpr SegmentCode kAltered{"49755003", "Morphologically Altered Structure"};

struct Known {
  std::string_view words;  // in lower case; a plural "s" may follow
  SegmentCode category, type;
};

// The first that fits counts: those of several words stand before their last one.
constexpr Known kKnown[] = {
    {"tumor", kAltered, {"108369006", "Neoplasm"}},
    {"tumour", kAltered, {"108369006", "Neoplasm"}},
    {"neoplasm", kAltered, {"108369006", "Neoplasm"}},
    {"metastasis", kAltered, {"108369006", "Neoplasm"}},
    {"lesion", kAltered, {"52988006", "Lesion"}},
    {"portal vein", kAnatomical, {"32764006", "Portal vein"}},
    {"hepatic vein", kAnatomical, {"8993003", "Hepatic vein"}},
    {"hepatic artery", kAnatomical, {"76015000", "Hepatic artery"}},
    {"vena cava", kAnatomical, {"64131007", "Inferior vena cava"}},
    {"aorta", kAnatomical, {"15825003", "Aorta"}},
    {"artery", kAnatomical, {"51114001", "Artery"}},
    {"arterie", kAnatomical, {"51114001", "Artery"}},
    {"vein", kAnatomical, {"29092000", "Vein"}},
    {"vessel", kAnatomical, {"59820001", "Blood vessel"}},
    {"liver", kAnatomical, {"10200004", "Liver"}},
    {"gallbladder", kAnatomical, {"28231008", "Gallbladder"}},
    {"gall bladder", kAnatomical, {"28231008", "Gallbladder"}},
    {"bile duct", kAnatomical, {"28273000", "Bile duct"}},
    {"bladder", kAnatomical, {"89837001", "Bladder"}},
    {"spleen", kAnatomical, {"78961009", "Spleen"}},
    {"pancreas", kAnatomical, {"15776009", "Pancreas"}},
    {"kidney", kAnatomical, {"64033007", "Kidney"}},
    {"adrenal gland", kAnatomical, {"23451007", "Adrenal gland"}},
    {"stomach", kAnatomical, {"69695003", "Stomach"}},
    {"duodenum", kAnatomical, {"38848004", "Duodenum"}},
    {"small bowel", kAnatomical, {"30315005", "Small intestine"}},
    {"small intestine", kAnatomical, {"30315005", "Small intestine"}},
    {"colon", kAnatomical, {"71854001", "Colon"}},
    {"esophagus", kAnatomical, {"32849002", "Esophagus"}},
    {"oesophagus", kAnatomical, {"32849002", "Esophagus"}},
    {"prostate", kAnatomical, {"41216001", "Prostate"}},
    {"lung", kAnatomical, {"39607008", "Lung"}},
    {"trachea", kAnatomical, {"44567001", "Trachea"}},
    {"heart", kAnatomical, {"80891009", "Heart"}},
    {"thyroid", kAnatomical, {"69748006", "Thyroid"}},
    {"lymph node", kAnatomical, {"59441001", "Lymph node"}},
    {"spinal cord", kAnatomical, {"2748008", "Spinal cord"}},
    {"brain", kAnatomical, {"12738006", "Brain"}},
    {"dura", kAnatomical, {"18545000", "Dura mater"}},
    {"dura mater", kAnatomical, {"18545000", "Dura mater"}},
    {"eye", kAnatomical, {"81745001", "Eye"}},
    {"skull", kAnatomical, {"89546000", "Skull"}},
    {"mandible", kAnatomical, {"91609006", "Mandible"}},
    {"tooth", kAnatomical, {"38199008", "Tooth"}},
    {"teeth", kAnatomical, {"38199008", "Tooth"}},
    {"vertebra", kAnatomical, {"51282000", "Vertebra"}},
    {"vertebrae", kAnatomical, {"51282000", "Vertebra"}},
    {"rib", kAnatomical, {"113197003", "Rib"}},
    {"femur", kAnatomical, {"71341001", "Femur"}},
    {"bone", kAnatomical, {"272673000", "Bone"}},
    {"muscle", kAnatomical, {"71616004", "Muscle"}},
    {"skin", kAnatomical, {"39937001", "Skin"}},
};

// In lower case, with one blank between words; what stands at the end for one of several goes.
std::string plainName(const std::string& name) {
  std::vector<std::string> words(1);
  for (const char c : name) {
    const bool letter =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || (c & 0x80);
    if (letter) {
      words.back() += c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    } else if (!words.back().empty()) {
      words.emplace_back();
    }
  }
  if (words.back().empty()) words.pop_back();
  const auto isOneOfSeveral = [](const std::string& word) {
    return word == "left" || word == "right" || word == "l" || word == "r" ||
           word.find_first_not_of("0123456789") == word.npos;
  };
  while (!words.empty() && isOneOfSeveral(words.back())) words.pop_back();
  std::string plain;
  for (const std::string& word : words) plain += (plain.empty() ? "" : " ") + word;
  return plain;
}

bool endsInWords(std::string_view name, std::string_view words) {
  return name.ends_with(words) &&
         (name.size() == words.size() || name[name.size() - words.size() - 1] == ' ');
}

}  // namespace

SegmentCodes segmentCodesOf(const std::string& name) {
  const std::string plain = plainName(name);
  for (const Known& known : kKnown) {
    const bool fits =
        endsInWords(plain, known.words) ||
        (plain.ends_with('s') &&
         endsInWords(std::string_view(plain).substr(0, plain.size() - 1), known.words));
    if (fits) return {known.category, known.type};
  }
  return {kTissue, kTissue};
}

}  // namespace trephine
