#include "imaging/series/detail/series_kind.h"

#include <cctype>
#include <cmath>
#include <map>

#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/common/detail/text.h"
#include "imaging/series/detail/findings.h"
#include "imaging/series/detail/series_geometry.h"
#include "volume/codes.h"

namespace trephine {

namespace {

// From the best to the worst: the worst of what a slice says of itself counts.
enum class Use { hu, asked, projection, no_hu };

struct Term {
  const char* term;  // in capitals, whatever stands between its words
  Use use;
  const char* words;
};

// PS3.3 C.8.2.1.1.1, C.8.15.2.1.1, C.8.16.1.3, C.8.16.1.4 and C.8.16.2.1: values 3 and 4 of Image
// Type or Frame Type, volumetric properties and technique. Also what makers write for the same.
constexpr Term kTerms[] = {
    {"SUBTRACTION", Use::no_hu, trLater("differences of two images")},
    {"DIVISION", Use::no_hu, trLater("ratios of two images")},
    {"MULTIPLICATION", Use::no_hu, trLater("products of two images")},
    {"ADDITION", Use::no_hu, trLater("sums of several images")},
    {"STD DEVIATION", Use::no_hu, trLater("standard deviations")},
    {"QUANTITY", Use::no_hu, trLater("a calculated quantity")},
    {"T TEST", Use::no_hu, trLater("a statistical map")},
    {"Z SCORE", Use::no_hu, trLater("a statistical map")},
    {"RCBF", Use::no_hu, trLater("a perfusion map (blood flow)")},
    {"CBF", Use::no_hu, trLater("a perfusion map (blood flow)")},
    {"RCBV", Use::no_hu, trLater("a perfusion map (blood volume)")},
    {"CBV", Use::no_hu, trLater("a perfusion map (blood volume)")},
    {"MTT", Use::no_hu, trLater("a perfusion map (mean transit time)")},
    {"TTP", Use::no_hu, trLater("a perfusion map (time to peak)")},
    {"TMAX", Use::no_hu, trLater("a perfusion map (time to maximum)")},
    {"MAT SPECIFIC", Use::no_hu, trLater("a map of one material")},
    {"MAT FRACTIONAL", Use::no_hu, trLater("a map of one material's share")},
    {"MAT VALUE BASED", Use::no_hu, trLater("a map of materials")},
    {"EFF ATOMIC NUM", Use::no_hu, trLater("effective atomic numbers")},
    {"ELECTRON DENSITY", Use::no_hu, trLater("electron densities")},
    {"IODINE", Use::no_hu, trLater("a map of one material")},
    {"CALCIUM", Use::no_hu, trLater("a map of one material")},
    {"Z EFF", Use::no_hu, trLater("effective atomic numbers")},
    {"VRT", Use::projection, trLater("a rendered picture")},
    {"SSD", Use::projection, trLater("a rendered picture")},
    {"MAX IP", Use::projection, trLater("a maximum intensity projection")},
    {"MIP", Use::projection, trLater("a maximum intensity projection")},
    {"MAXIMUM", Use::projection, trLater("the maximum of several images")},
    {"MIN IP", Use::projection, trLater("a minimum intensity projection")},
    {"MINIP", Use::projection, trLater("a minimum intensity projection")},
    {"MINIMUM", Use::projection, trLater("the minimum of several images")},
    {"PROJECTION", Use::projection, "a projection"},
    {"VOLUME RENDER", Use::projection, trLater("a rendered picture")},
    {"SURFACE RENDER", Use::projection, trLater("a rendered picture")},
    {"CURVED MPR", Use::projection, trLater("slices along a curve")},
    {"DISTORTED", Use::projection, trLater("distorted slices")},
    {"SAMPLED", Use::projection, "a projection"},
    {"MPR", Use::asked, trLater("reformatted from other slices")},
    {"REFORMATTED", Use::asked, trLater("reformatted from other slices")},
    {"RESAMPLED", Use::asked, trLater("resampled from other slices")},
    {"MEAN", Use::asked, trLater("means of several images")},
    {"AVERAGE", Use::asked, trLater("means of several images")},
    {"MASKED", Use::asked, trLater("masked: parts of them are not what was scanned")},
    {"FILTERED", Use::asked, "filtered"},
    {"VNC", Use::asked, trLater("calculated as if contrast agent were not there")},
    {"VMI", Use::asked,
     trLater("virtual monoenergetic: their HU depend on the energy that was chosen")},
    {"MAT REMOVED", Use::asked, trLater("calculated as if a material were not there")},
    {"MAT MODIFIED", Use::asked, trLater("calculated with a material brought out or held back")},
    {"ENERGY PROP WT", Use::asked, trLater("weighted sums over energies")},
};

// " A B / C ": words in capitals, so that each is found whole.
std::string words(const std::string& value) {
  std::string text = " ";
  for (const char c : value) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte)) {
      text += char(std::toupper(byte));
    } else if (text.back() != ' ') {
      text += ' ';
    }
  }
  return text.back() == ' ' ? text + "/" : text + " /";
}

struct Kind {
  Use use = Use::hu;
  std::string words;
};

Kind kindOf(const DicomHeader& header) {
  const std::vector<std::string>& type = header.image_type;
  std::string said = words(header.volumetric) + words(header.technique);
  for (std::size_t n = 2; n < type.size(); ++n) said += words(type[n]);
  Kind kind;
  for (const Term& term : kTerms) {
    if (term.use <= kind.use) continue;
    if (said.find(" " + std::string(term.term) + " ") == said.npos) continue;
    kind = {term.use, tr(term.words)};
  }
  // A scan of the passing contrast holds HU, a map that was made of it does not.
  if (kind.use != Use::no_hu && said.find(" PERFUSION ") != said.npos) {
    if (type.empty() || type.front() != "ORIGINAL") return {Use::no_hu, tr("a perfusion map")};
    if (kind.use == Use::hu)
      return {Use::asked,
              tr("of a perfusion study, which is low in dose and shows contrast on its way")};
  }
  if (kind.use == Use::hu && type.size() > 3 && type[3] == "MIXED") {
    return {Use::asked, tr("of several kinds that they do not name")};
  }
  return kind;
}

// The scale of a map that is not that of the rescale; nothing where there is none.
std::string otherScale(const DicomHeader& header) {
  const auto near = [](const std::optional<double>& a, double b) {
    return a && std::abs(*a - b) <= 1e-6 * std::max(1.0, std::abs(b));
  };
  for (const DicomHeader::ValueMap& map : header.value_maps) {
    if (map.unit != "[hnsf'U]" && map.unit != "HU") {
      return map.unit.empty() ? tr("an unnamed unit") : "'" + shownTerm(map.unit) + "'";
    }
    if (!near(map.slope, header.format.slope) || !near(map.intercept, header.format.intercept)) {
      return tr("other HU");
    }
  }
  return "";
}

}  // namespace

void checkKind(Series& series, const Answers& answers) {
  using Slices = std::vector<std::string>;
  std::map<std::pair<Use, std::string>, Slices> kinds;
  std::map<std::string, Slices> scales;
  Slices tables, coloured;
  for (const DicomHeader& header : series.slices) {
    if (!header.has_pixels) continue;
    const std::string name = sliceName(header);
    if (const Kind kind = kindOf(header); kind.use != Use::hu) {
      kinds[{kind.use, kind.words}].push_back(name);
    }
    if (const std::string scale = otherScale(header); !scale.empty()) scales[scale].push_back(name);
    if (header.modality_lut) tables.push_back(name);
    if (!header.presentation.empty() && header.presentation != "MONOCHROME") {
      coloured.push_back(name);
    }
  }
  Findings findings(series);
  if (!coloured.empty()) {
    findings.refuse(code::kColour,
                    trCount(coloured.size(), "{} slice holds pixels that stand for colours, not HU",
                            "{} slices hold pixels that stand for colours, not HU"),
                    tr("Export the original CT slices"), coloured);
  }
  if (!tables.empty()) {
    findings.refuse(
        code::kNotHu,
        trCount(tables.size(),
                "{} slice needs a look-up table (Modality LUT) to become HU, which is not read",
                "{} slices need a look-up table (Modality LUT) to become HU, which is not read"),
        tr("Export the series with a rescale slope and intercept"), tables);
  }
  Slices derived;
  std::vector<std::string> derived_words;
  for (const auto& [kind, slices] : kinds) {
    if (kind.first == Use::no_hu) {
      findings.refuse(code::kNotHu,
                      trCount(slices.size(), "{} slice holds {}, not HU",
                              "{} slices hold {}, not HU", kind.second),
                      tr("Choose the series that it was calculated from"), slices);
    } else if (kind.first == Use::projection) {
      findings.refuse(code::kProjection,
                      trCount(slices.size(), "{} slice holds {}, not what lies at their place",
                              "{} slices hold {}, not what lies at their place", kind.second),
                      tr("Choose the series that it was calculated from"), slices);
    } else {
      derived.insert(derived.end(), slices.begin(), slices.end());
      derived_words.push_back(kind.second);
    }
  }
  if (!derived.empty()) {
    findings.askConsent(
        {code::kDerivedImages,
         tr("The slices are not as they were scanned, or were scanned for another purpose. Use "
            "them?"),
         {"refuse", "accept"},
         {tr("Do not use the series"),
          tr("Use them: detail and HU may differ from those of the slices that were scanned")}},
        answers,
        trCount(derived.size(), "{} slice is {}", "{} slices are {}", listed(derived_words)),
        tr("They were taken as they are, as was agreed"),
        tr("Choose the series as it was scanned, or agree to use this one"), derived);
  }
  if (!scales.empty()) {
    const auto& [scale, slices] = *scales.begin();
    findings.askConsent(
        {code::kValueMap,
         tr("The header gives the values another meaning beside HU. Take them as HU?"),
         {"refuse", "accept"},
         {tr("Do not use the series"),
          tr("Take slope and intercept for HU and leave the map aside")}},
        answers,
        trCount(slices.size(),
                "{} slice has a real-world value map to {} beside slope and intercept",
                "{} slices have a real-world value map to {} beside slope and intercept", scale),
        tr("The map was left aside, as was agreed"),
        tr("Choose the series in HU, or agree to leave the map aside"), slices);
  }
}

}  // namespace trephine
