#include "desk/opening.h"

#include <algorithm>
#include <new>

#include "base/memory.h"
#include "base/system.h"
#include "base/tr.h"
#include "library/name_words.h"
#include "volume/case_memory.h"
#include "volume/volume.h"

namespace trephine {

std::filesystem::path defaultExercise(const std::string& anatomy) {
  return resourceFolder() / "scenes" / (anatomy == "abdomen" ? "liver.json" : "cranium.json");
}

Result<Exercise> readAllowedExercise(const std::filesystem::path& file, const Policy* policy) {
  Result<Exercise> exercise = readExercise(file);
  if (!exercise || !policy) return exercise;
  if (Status may = checkExercise(*policy, *exercise, file); !may) return may.error();
  return exercise;
}

namespace {

// Of all work, until the case is there: one of the library, one that is read.
constexpr double kLoaded = 0.7, kRead = 0.9;

// The case that was asked for, as it is without a file of structures.
Result<Case> caseOfRequest(OpenRequest& request, Opened& opened, const Progress& progress) {
  if (!request.load) return *request.of;
  Result<StoredCase> stored = std::exchange(request.load, {})(Progress(progress, 0.0, kLoaded));
  if (!stored) return stored.error();
  opened.tissues = std::move(stored->tissues);
  opened.no_tissues = std::move(stored->no_tissues);
  opened.no_structures = std::move(stored->no_structures);
  stored->of.source = request.source;
  return std::move(stored->of);
}

// The case with the structures of the request's file; or what is asked about them.
using CaseAnswer = std::variant<Case, StructureAsked>;
Result<CaseAnswer> withStructuresOf(const OpenRequest& request, Case of, const Progress& progress) {
  StructureRequest structures = requestOf(of, hideNamesOf);
  structures.answers = request.answers;
  structures.ask_all = request.structures_alone;
  structures.ask_person = request.structures_alone;
  Result<StructureAnswer> answer = request.structures->fit(*of.volume, structures, progress);
  if (!answer) return answer.error();
  if (auto* asked = std::get_if<StructureAsked>(&*answer)) return CaseAnswer(std::move(*asked));
  return CaseAnswer(withFit(std::move(of), std::get<StructureFit>(*std::move(answer))));
}

// Nobody chose the exercise, and it is for another region than the case shows.
void chooseExercise(const OpenRequest& request, const Case& of, Opened& opened) {
  const std::string fits = request.any_exercise ? exerciseAnatomy(of.anatomy->region) : "";
  if (fits.empty() || fits == opened.exercise.anatomy) return;
  const std::filesystem::path file = defaultExercise(fits);
  Result<Exercise> other = readAllowedExercise(file, request.policy ? &*request.policy : nullptr);
  if (!other) return;
  opened.exercise = *std::move(other);
  opened.exercise_file = file;
  opened.same_exercise = false;
}

}  // namespace

Result<OpenOutcome> openOnDesk(OpenRequest request, const Progress& progress) {
  Opened opened{request.exercise, request.exercise_file, request.same_exercise,
                request.structures_alone};
  std::optional<Case> of;
  double at = 0.0;
  if (request.of || request.load) {
    if (request.load) at = kLoaded;
    Result<Case> had = caseOfRequest(request, opened, progress);
    if (!had) return had.error();
    of = *std::move(had);
  }
  if (of && request.structures) {
    auto labelled = withStructuresOf(request, *of, Progress(progress, at, 1.0));
    if (!labelled && of->volume == request.shown) return labelled.error();
    if (!labelled) {
      opened.no_labels = labelled.error();
    } else if (auto* asked = std::get_if<StructureAsked>(&*labelled)) {
      return OpenOutcome(StructureQuestion{std::move(*asked), std::move(request)});
    } else {
      of = std::get<Case>(*std::move(labelled));
    }
    request.structures.reset();  // its memory
  }
  if (of && !of->anatomy) of->anatomy = anatomyOf(*of->volume, Progress(progress, at, 1.0));
  if (of) {
    chooseExercise(request, *of, opened);
  } else {
    Result<Case> read = readCase(request.source, Progress(progress, 0.0, kRead));
    if (!read) return read.error();
    of = *std::move(read);
    at = kRead;
  }
  const Exercise here = onCase(opened.exercise, of->source);
  const bool without_its_own = opened.exercise.tissues_elsewhere && !here.tissues_elsewhere;
  Result<Placement> placed = place(here, *std::move(of), Progress(progress, at, 1.0), hideNamesOf);
  if (!placed) return placed.error();
  opened.placed = *std::move(placed);
  if (without_its_own) opened.placed.elsewhere = true;
  return OpenOutcome(std::move(opened));
}

Status addMirror(Opened& opened, const std::shared_ptr<const Volume>& shown) {
  const Placement& placed = opened.placed;
  if (placed.patient.volume == shown) return {};
  const Volume& volume = *placed.patient.volume;
  const std::size_t voxels = volume.geometry.voxelCount();
  const double needed_mb = shownMb(voxels) + (placed.labels ? labelsMb(voxels) : 0.0);
  if (Status enough = enoughMemory(needed_mb, tr("Showing the case"), tr("the case")); !enough) {
    return enough;
  }
  try {
    opened.mirror = copyOf(volume);
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("to show the case"), tr("the case"));
  }
  return {};
}

}  // namespace trephine
