// Structures of a CT from a file of any kind that is read: names, place, HU; whether they belong to
// the CT at all; questions where a person has to decide. What other rooms use.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "imaging/common/source_ids.h"
#include "imaging/segmentation/structure_fit.h"
#include "volume/segmentation.h"
#include "volume/volume.h"

namespace trephine {

struct StructureRequest {
  // To the questions, by code; THRESHOLD takes a share from 0 to 1 and goes before `threshold`.
  Answers answers;
  // Whether an open choice whose first option is to refuse is an Error of its code, or taken as
  // "keep" and said.
  bool ask_all = true;
  // A person is there: what is open comes as StructureAsked, of shares and overlaps too.
  bool ask_person = false;
  // What the CT is of; empty where it is not known (a volume file).
  SourceIds ct{};
  double threshold = 0.5;  // of a fractional DICOM SEG
  // Gives other names to those that tell who the patient is, before anything is said or made of
  // them; how many there were. Empty: the names stay.
  std::function<int(Segmentation&)> hide_names{};
};

// What only a person can decide about a file that can be used; answered under choice.code.
struct StructureAsked {
  enum class Kind {
    option,     // one of choice.options, each of which uses the file
    order,      // of `names`, which share voxels: orderAnswer() of those that have them first
    threshold,  // a number from 0 to 1: from which share on a structure has a voxel
  };
  Kind kind = Kind::option;
  Choice choice;
  std::vector<std::string> names{};  // in the order that would be taken
};

using StructureAnswer = std::variant<StructureFit, StructureAsked>;

// A file with structures. It is read once, however often it is fitted with other answers. One
// thread at a time.
class StructureFile {
 public:
  explicit StructureFile(std::filesystem::path file);
  ~StructureFile();

  const std::filesystem::path& path() const;
  // RENAMED_STRUCTURE among the findings says that names were hidden; SOURCE_UNCHECKED that whose
  // the file is could not be told. A DICOM SEG belongs to the CT by its frame of reference. One
  // with another is asked about (OTHER_FRAME: refuse, keep) where its grid lies within half a voxel
  // on the CT's; else it is refused: OTHER_PATIENT where the study is another one as well, else
  // OTHER_FRAME.
  // Other errors: those of readSegmentation() or readDicomSegmentation(), and fitStructures(). Any
  // thread.
  Result<StructureAnswer> fit(const Volume& ct, const StructureRequest& request,
                              const Progress& progress = Progress());

 private:
  struct Read;
  std::unique_ptr<Read> read_;
};

// The same at once, where no person is there to be asked.
Result<StructureFit> importStructures(const std::filesystem::path& file, const Volume& ct,
                                      const StructureRequest& request = {},
                                      const Progress& progress = Progress());

}  // namespace trephine
