#include "imaging/structure_importer.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "imaging/dicom/seg_reader.h"
#include "imaging/report/answers.h"
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
Status match(const DicomSegmentation& seg, const Volume& ct, const StructureRequest& request,
             std::optional<Choice>& asked) {
  const SourceIds &of = seg.of, &to = request.ct;
  if (to.unreadable) {
    if (liesOn(seg.segmentation.geometry, ct.geometry)) return {};
    return Error{
        "OTHER_FRAME",
        "Whether the segmentation was made from this CT cannot be checked by this account, "
        "and it does not lie on it",
        "the segmentation", "Choose the one that was made from this CT"};
  }
  const bool frames = !of.frame_of_reference.empty() && !to.frame_of_reference.empty();
  if (to.standsFor(to.frame_of_reference, of.frame_of_reference)) return {};
  const bool other_study =
      !of.study.empty() && !to.study.empty() && !to.standsFor(to.study, of.study);
  // Of a CT that says nothing of itself only the place can speak, which is looked at later.
  if (!frames && !other_study) return {};
  if (!liesOn(seg.segmentation.geometry, ct.geometry)) {
    const std::string whose =
        other_study ? "of another study, of this patient or another," : "of another scan";
    return Error{other_study ? "OTHER_PATIENT" : "OTHER_FRAME",
                 "The segmentation is " + whose + " and does not lie on this CT",
                 "the segmentation", "Choose the one that was made from this CT"};
  }
  Choice choice{"OTHER_FRAME",
                std::string("The segmentation is of another ") +
                    (other_study ? "study, perhaps of another patient," : "frame of reference") +
                    " though its voxels lie on those of this CT",
                {"refuse", "keep"},
                {"Do not use the segmentation", "Use it: it is of this patient"}};
  const auto given = request.answers.find(choice.code);
  const bool keep = given != request.answers.end() ? given->second == "keep" : !request.ask_all;
  if (!keep) {
    return Error{choice.code, choice.question, "the segmentation",
                 "Choose another file, or answer OTHER_FRAME=keep"};
  }
  asked = std::move(choice);
  return {};
}

// Of a label map that says in two ways how it lies in the patient (volume_files.h): what was
// answered, else the one that puts it on the CT's voxels. Empty: none of them alone does.
std::string formOf(const std::filesystem::path& file, const Volume& ct, const Answers& answers,
                   std::optional<Finding>& said) {
  constexpr const char* kCode = "FORMS_DIFFER";
  constexpr double kSame = 0.1;  // of a voxel
  if (const std::string given = answerTo(answers, kCode); !given.empty()) return given;
  const Result<VolumeFileHeader> header = readVolumeFileHeader(file);
  if (!header || header->forms.empty()) return "";
  const Vec3& mm = ct.geometry.spacing_mm;
  double least_mm = kSame * std::min({mm.x, mm.y, mm.z});
  std::string nearest;
  for (const VolumeFileHeader::Form& form : header->forms) {
    const double apart_mm = cornersFrom_mm(form.geometry, ct.geometry);
    if (apart_mm > least_mm) continue;
    least_mm = apart_mm;
    nearest = form.name;
  }
  if (nearest.empty()) return "";
  said = Finding{kCode,
                 "notice",
                 header->contradiction,
                 {},
                 "The " + nearest + " puts it on the CT's voxels, and was taken"};
  return nearest;
}

int hideNames(Segmentation& segmentation, const StructureRequest& request) {
  return request.hide_names ? request.hide_names(segmentation) : 0;
}

// Of DICOM that holds something else.
Error noSegmentation(const std::string& kind, const std::filesystem::path& file) {
  constexpr const char* kContours = "1.2.840.10008.5.1.4.1.1.481.3";
  if (kind == kContours) {
    return {"CONTOURS", "The file holds contours (an RT Structure Set), which are not read yet",
            file.string(), "Export the structures as a DICOM Segmentation or as a label map"};
  }
  return {"NOT_SEGMENTATION", "The file is DICOM, but no segmentation", file.string(),
          "Choose a file of modality SEG, or a label map"};
}

void sayHidden(StructureFit& fit, int hidden) {
  if (hidden == 0) return;
  fit.findings.push_back(
      {"RENAMED_STRUCTURE",
       "notice",
       hidden == 1
           ? "The name of a structure told who the patient is"
           : "The names of " + std::to_string(hidden) + " structures told who the patient is",
       {},
       hidden == 1 ? "It is called by its label" : "They are called by their labels"});
}

}  // namespace

Result<StructureFit> importStructures(const std::filesystem::path& file, const Volume& ct,
                                      const StructureRequest& request, const Progress& progress) {
  const Progress reading(progress, 0.0, 0.5), fitting(progress, 0.5, 1.0);
  const std::string kind = dicomKind(file, reading);
  if (reading.cancelled()) {
    return Error{"CANCELLED", "Reading the segmentation was cancelled", "", ""};
  }
  if (!isSegmentation(kind)) {
    if (!kind.empty()) return noSegmentation(kind, file);
    std::optional<Finding> form;
    Result<Segmentation> read =
        readSegmentation(file, reading, formOf(file, ct, request.answers, form));
    if (!read) return read.error();
    const int hidden = hideNames(*read, request);
    Result<StructureFit> fit =
        fitStructures(*std::move(read), ct, request.answers, request.ask_all, fitting);
    if (fit && form) fit->findings.push_back(*std::move(form));
    if (fit) sayHidden(*fit, hidden);
    return fit;
  }
  Result<DicomSegmentation> read = readDicomSegmentation(file, request.threshold, reading);
  if (!read) return read.error();
  if (read->fractional && request.ask_threshold) {
    return Error{"THRESHOLD", "The file says how much of each voxel a structure has",
                 "the segmentation", "Say from which share on it has a voxel"};
  }
  const int hidden = hideNames(read->segmentation, request);
  std::optional<Choice> asked;
  if (Status of = match(*read, ct, request, asked); !of) return of.error();
  Result<StructureFit> fit =
      fitStructures(std::move(read->segmentation), ct, request.answers, request.ask_all, fitting);
  if (fit && read->fractional) {
    fit->fractional = true;
    fit->findings.push_back(
        {"FRACTIONAL",
         "notice",
         "The file says how much of each voxel a structure has",
         {},
         "It has a voxel from a share of " + plainNumber(request.threshold) + " on"});
  }
  if (fit) sayHidden(*fit, hidden);
  if (fit && request.ct.unreadable) {
    fit->findings.push_back(
        {"SOURCE_UNCHECKED",
         "notice",
         "Whether the segmentation was made from this CT cannot be checked: what the case was made "
         "from is kept where this account may not read it",
         {},
         "Its place alone was compared"});
  }
  if (fit && asked) {
    fit->findings.push_back({asked->code, "notice", asked->question, {}, "It was kept"});
    fit->choices.push_back(*std::move(asked));
  }
  return fit;
}

}  // namespace trephine
