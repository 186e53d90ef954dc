#include "imaging/structure_importer.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/codes.h"
#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/common/detail/text.h"
#include "imaging/dicom/seg_reader.h"
#include "imaging/report/answers.h"
#include "volume/codes.h"
#include "volume/grid_place.h"
#include "volume/segmentation.h"
#include "volume/volume_files.h"

namespace trephine {

namespace {

// Whether the grid's voxels are the CT's, each within half a voxel; both are straight, so its axes
// and corners decide.
bool liesOn(const GridGeometry& of, const GridGeometry& ct) {
  const Mat4 to_ct = ct.patientToVoxel() * of.voxelToPatient();
  for (int axis = 0; axis < 3; ++axis) {
    // A step is a whole number of steps of the CT.
    Vec3 drift(to_ct[axis]);
    for (int p = 0; p < 3; ++p) drift[p] -= std::round(drift[p]);
    const double steps = of.size[std::size_t(axis)] - 1;
    if (glm::length(Vec3(to_ct[axis])) < 0.5 || steps * glm::length(drift) > 0.5) return false;
  }
  for (const Vec3& at : cornerVoxels(of)) {
    const Vec3 voxel(to_ct * glm::dvec4(at, 1.0));
    for (int p = 0; p < 3; ++p) {
      if (voxel[p] < -0.5 || voxel[p] > ct.size[std::size_t(p)] - 0.5) return false;
    }
  }
  return true;
}

// A choice about where the file belongs, as those of fitStructures().
// `answered` with "keep" by request, or `open`: nobody has answered.
Status match(const DicomSegmentation& seg, const Volume& ct, const StructureRequest& request,
             std::optional<Choice>& answered, std::optional<Choice>& open) {
  const SourceIds &of = seg.of, &to = request.ct;
  if (to.unreadable) {
    if (liesOn(seg.segmentation.geometry, ct.geometry)) return {};
    return Error{
        code::kOtherFrame,
        tr("Whether the segmentation was made from this CT cannot be checked by this account, "
           "and it does not lie on it"),
        tr("the segmentation"), tr("Choose the one that was made from this CT")};
  }
  const bool frames = !of.frame_of_reference.empty() && !to.frame_of_reference.empty();
  if (to.standsFor(to.frame_of_reference, of.frame_of_reference)) return {};
  const bool other_study =
      !of.study.empty() && !to.study.empty() && !to.standsFor(to.study, of.study);
  // Of a CT that says nothing of itself only the place can speak, which is looked at later.
  if (!frames && !other_study) return {};
  if (!liesOn(seg.segmentation.geometry, ct.geometry)) {
    const std::string whose =
        other_study ? tr("of another study, of this patient or another,") : tr("of another scan");
    return Error{other_study ? code::kOtherPatient : code::kOtherFrame,
                 tr("The segmentation is {} and does not lie on this CT", whose),
                 tr("the segmentation"), tr("Choose the one that was made from this CT")};
  }
  Choice choice{
      code::kOtherFrame,
      tr("The segmentation is of another {} though its voxels lie on those of this CT",
         (other_study ? tr("study, perhaps of another patient,") : tr("frame of reference"))),
      {"refuse", "keep"},
      {tr("Do not use the segmentation"), tr("Use it: it is of this patient")}};
  const auto given = request.answers.find(choice.code);
  const bool keep = given != request.answers.end() ? given->second == "keep" : !request.ask_all;
  if (!keep) {
    if (given != request.answers.end()) return notUsed(choice);
    open = std::move(choice);
    return {};
  }
  answered = std::move(choice);
  return {};
}

// Of a label map that says in two ways how it lies in the patient (volume_files.h): what was
// answered, else the one that puts it on the CT's voxels. Empty: none of them alone does, and the
// choice is `open`.
std::string formOf(const VolumeFileHeader& header, const Volume& ct, const Answers& answers,
                   std::optional<Finding>& said, std::optional<Choice>& open) {
  constexpr Code kCode = code::kFormsDiffer;
  constexpr double kSame = 0.1;  // of a voxel
  if (const std::string given = answerTo(answers, kCode); !given.empty()) return given;
  if (header.forms.empty()) return "";
  const Vec3& mm = ct.geometry.spacing_mm;
  double least_mm = kSame * std::min({mm.x, mm.y, mm.z});
  std::string nearest;
  for (const VolumeFileHeader::Form& form : header.forms) {
    const double apart_mm = cornersFrom_mm(form.geometry, ct.geometry);
    if (apart_mm > least_mm) continue;
    least_mm = apart_mm;
    nearest = form.name;
  }
  if (nearest.empty()) {
    open = Choice{kCode, header.contradiction, {"refuse"}, {}};
    for (const VolumeFileHeader::Form& form : header.forms) open->options.push_back(form.name);
    return "";
  }
  said = Finding{kCode,
                 Severity::notice,
                 header.contradiction,
                 {},
                 tr("The {} puts it on the CT's voxels, and was taken", nearest)};
  return nearest;
}

int hideNames(Segmentation& segmentation, const StructureRequest& request) {
  return request.hide_names ? request.hide_names(segmentation) : 0;
}

Error cancelled() {
  return {code::kCancelled, tr("Reading the segmentation was cancelled"), "", ""};
}

// Of DICOM that holds something else.
Error noSegmentation(const std::string& kind, const std::filesystem::path& file) {
  constexpr const char* kContours = "1.2.840.10008.5.1.4.1.1.481.3";
  if (kind == kContours) {
    return {code::kContours,
            tr("The file holds contours (an RT Structure Set), which are not read yet"),
            file.string(), tr("Export the structures as a DICOM Segmentation or as a label map")};
  }
  return {code::kNotSegmentation, tr("The file is DICOM, but no segmentation"), file.string(),
          tr("Choose a file of modality SEG, or a label map")};
}

void sayHidden(StructureFit& fit, int hidden) {
  if (hidden == 0) return;
  fit.findings.push_back(
      {code::kRenamedStructure,
       Severity::notice,
       trCount(std::uint64_t(hidden), "The name of a structure told who the patient is",
               "The names of {} structures told who the patient is"),
       {},
       trCount(std::uint64_t(hidden), "It is called by its label",
               "They are called by their labels")});
}

}  // namespace

struct StructureFile::Read {
  std::filesystem::path file;
  // Once they are known: dicomKind(), isFractional(), the header of a label map.
  std::optional<std::string> kind;
  std::optional<bool> fractional;
  std::optional<VolumeFileHeader> header;
  // What was read, and for which answer.
  std::optional<DicomSegmentation> dicom;
  double threshold = 0.0;
  std::optional<Segmentation> map;
  std::string form;

  Status readKind(const Progress& progress);
  Result<bool> isOfShares(const Progress& progress);
  Status readMap(const std::string& with_form, const Progress& progress);
  Status readDicom(double with_threshold, const Progress& progress);
  Result<FitAnswer> fitMap(const Volume& ct, const StructureRequest& request,
                           const Progress& progress);
  Result<FitAnswer> fitDicom(const Volume& ct, const StructureRequest& request,
                             const Progress& progress);
};

Status StructureFile::Read::readKind(const Progress& progress) {
  if (kind) return {};
  std::string found = dicomKind(file, progress);
  if (progress.cancelled()) return cancelled();
  kind = std::move(found);
  return {};
}

Result<bool> StructureFile::Read::isOfShares(const Progress& progress) {
  if (fractional) return *fractional;
  const Result<bool> read = isFractional(file, progress);
  if (progress.cancelled()) return cancelled();
  if (read) fractional = *read;
  return read;
}

Status StructureFile::Read::readMap(const std::string& with_form, const Progress& progress) {
  if (map && form == with_form) return {};
  map.reset();
  Result<Segmentation> read = readSegmentation(file, progress, with_form);
  if (!read) return read.error();
  map = *std::move(read);
  form = with_form;
  return {};
}

Status StructureFile::Read::readDicom(double with_threshold, const Progress& progress) {
  if (dicom && (!dicom->fractional || threshold == with_threshold)) return {};
  dicom.reset();
  Result<DicomSegmentation> read = readDicomSegmentation(file, with_threshold, progress);
  if (!read) return read.error();
  dicom = *std::move(read);
  threshold = with_threshold;
  return {};
}

Result<FitAnswer> StructureFile::Read::fitMap(const Volume& ct, const StructureRequest& request,
                                              const Progress& progress) {
  std::optional<Finding> said;
  std::optional<Choice> open;
  if (!header) {
    if (Result<VolumeFileHeader> read = readVolumeFileHeader(file)) header = *std::move(read);
  }
  // What has no header that can be read is for who reads the rest to say.
  const std::string with_form =
      formOf(header.value_or(VolumeFileHeader()), ct, request.answers, said, open);
  if (open) return FitAnswer(*std::move(open));
  if (Status read = readMap(with_form, Progress(progress, 0.0, 0.5)); !read) return read.error();
  // A copy where a person may be asked, and it is fitted once more.
  Segmentation segmentation =
      request.ask_person ? *map : *std::exchange(map, std::optional<Segmentation>());
  const int hidden = hideNames(segmentation, request);
  Result<FitAnswer> answer = fitStructures(std::move(segmentation), ct, request.answers,
                                           request.ask_all, Progress(progress, 0.5, 1.0));
  auto* fit = answer ? std::get_if<StructureFit>(&*answer) : nullptr;
  if (!fit) return answer;
  if (said) fit->findings.push_back(*std::move(said));
  sayHidden(*fit, hidden);
  return answer;
}

Result<FitAnswer> StructureFile::Read::fitDicom(const Volume& ct, const StructureRequest& request,
                                                const Progress& progress) {
  if (Status read = readDicom(request.threshold, Progress(progress, 0.0, 0.5)); !read) {
    return read.error();
  }
  std::optional<Choice> answered, open;
  if (Status of = match(*dicom, ct, request, answered, open); !of) return of.error();
  if (open) return FitAnswer(*std::move(open));
  Segmentation segmentation =
      request.ask_person ? dicom->segmentation : std::exchange(dicom->segmentation, {});
  const int hidden = hideNames(segmentation, request);
  Result<FitAnswer> answer = fitStructures(std::move(segmentation), ct, request.answers,
                                           request.ask_all, Progress(progress, 0.5, 1.0));
  auto* fit = answer ? std::get_if<StructureFit>(&*answer) : nullptr;
  if (!fit) return answer;
  if (dicom->fractional) {
    fit->fractional = true;
    fit->findings.push_back(
        {code::kFractional,
         Severity::notice,
         tr("The file says how much of each voxel a structure has"),
         {},
         tr("It has a voxel from a share of {} on", plainNumber(request.threshold))});
  }
  sayHidden(*fit, hidden);
  if (request.ct.unreadable) {
    fit->findings.push_back({code::kSourceUnchecked,
                             Severity::notice,
                             tr("Whether the segmentation was made from this CT cannot be checked: "
                                "what the case was made "
                                "from is kept where this account may not read it"),
                             {},
                             tr("Its place alone was compared")});
  }
  if (answered) {
    fit->findings.push_back(
        {answered->code, Severity::notice, answered->question, {}, tr("It was kept")});
    fit->choices.push_back(*std::move(answered));
  }
  return answer;
}

StructureFile::StructureFile(std::filesystem::path file) : read_(std::make_unique<Read>()) {
  read_->file = std::move(file);
}

StructureFile::~StructureFile() = default;

const std::filesystem::path& StructureFile::path() const {
  return read_->file;
}

namespace {

constexpr Code kThreshold = code::kThreshold;
constexpr Code kOverlap = code::kOverlap;

// The options that use the file. That a file which says nothing of its place is right as it stands
// is for who made it: the command line's.
StructureAsked askedOption(Choice choice) {
  const bool by_size = std::ranges::find(choice.options, "ct") != choice.options.end();
  std::erase_if(choice.options, [&](const std::string& option) {
    return option == "refuse" || (by_size && option == "keep");
  });
  choice.words.clear();
  return {StructureAsked::Kind::option, std::move(choice)};
}

}  // namespace

Result<StructureAnswer> StructureFile::fit(const Volume& ct, const StructureRequest& request,
                                           const Progress& progress) {
  if (Status known = read_->readKind(progress); !known) return known.error();
  const bool dicom = isSegmentation(*read_->kind);
  if (!dicom && !read_->kind->empty()) return noSegmentation(*read_->kind, read_->file);
  StructureRequest wanted = request;
  const std::string share = answerTo(request.answers, kThreshold);
  if (!share.empty()) wanted.threshold = parseDecimal(share).value_or(wanted.threshold);
  if (dicom && request.ask_person && share.empty()) {
    const Result<bool> fractional = read_->isOfShares(progress);
    if (!fractional) return fractional.error();
    if (*fractional) {
      return StructureAnswer(StructureAsked{
          StructureAsked::Kind::threshold,
          Choice{kThreshold, tr("From which share of a voxel on has a structure it?"), {}, {}}});
    }
  }
  Result<FitAnswer> answer =
      dicom ? read_->fitDicom(ct, wanted, progress) : read_->fitMap(ct, wanted, progress);
  if (auto* open = answer && request.ask_person ? std::get_if<Choice>(&*answer) : nullptr) {
    return StructureAnswer(askedOption(std::move(*open)));
  }
  Result<StructureFit> fit = fitOf(std::move(answer));
  if (!fit) return fit.error();
  if (request.ask_person && !fit->overlapping.empty() && !request.answers.contains(kOverlap)) {
    const auto choice = std::ranges::find(fit->choices, kOverlap, &Choice::code);
    if (choice != fit->choices.end()) {
      return StructureAnswer(
          StructureAsked{StructureAsked::Kind::order, *choice, fit->overlapping});
    }
  }
  return StructureAnswer(*std::move(fit));
}

Result<StructureFit> importStructures(const std::filesystem::path& file, const Volume& ct,
                                      const StructureRequest& request, const Progress& progress) {
  StructureRequest alone = request;
  alone.ask_person = false;
  Result<StructureAnswer> answer = StructureFile(file).fit(ct, alone, progress);
  if (!answer) return answer.error();
  return std::get<StructureFit>(*std::move(answer));
}

}  // namespace trephine
