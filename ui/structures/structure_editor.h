// The structures of the open case while a person makes and mends them. No widget: it holds what is
// edited, which all views show meanwhile, does the work in the background and says what came of it;
// the panel and the slices tell it what to do.
//
// Everything is on the window's thread but growing and what else takes over a second, which only
// reads the map; while that runs (busy()) nothing else is changed.
#pragma once

#include <QObject>
#include <QString>
#include <algorithm>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include "exercise/structure_view.h"
#include "structures/edited_structures.h"
#include "structures/grow.h"
#include "structures/shape_tools.h"
#include "ui/common/background_task.h"
#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

class StructureEditor : public QObject {
  Q_OBJECT
 public:
  explicit StructureEditor(QObject* parent = nullptr);

  // Another case, or none (null); `structures` are on its grid, null for none yet. Forgets what was
  // done to those before.
  void setCase(std::shared_ptr<const Volume> volume,
               const std::shared_ptr<const LabelMap>& structures);
  // Those of the exercise, whose colours new structures of their names take.
  void setTissues(const TissueSet& tissues) { tissues_ = tissues; }
  // While an exercise runs, is started or ended nothing may change: `why` says so. Empty: it may.
  void setLocked(const QString& why);
  bool hasCase() const { return volume_ != nullptr; }

  // What the views show; null: the case has none and nothing was made. From the first change on it
  // is the editor's own, which changes in place, with changed() for each box.
  std::shared_ptr<const LabelMap> map() const { return structures_.map(); }
  double millilitres(int label) const { return structures_.millilitres(label); }
  // Since setCase() or markSaved().
  bool edited() const { return structures_.version() != saved_; }
  // EditedStructures::version(), and that of what was saved.
  std::uint64_t version() const { return structures_.version(); }
  void markSaved(std::uint64_t version) { saved_ = version; }
  // What was taken last could not be used: it is there to be taken again.
  void giveBack();
  bool isOf(const std::shared_ptr<const Volume>& volume) const { return volume_ == volume; }
  // Since setCase() or the last call; a copy of the map then, as finished() gives it, else null.
  // Not while a preview stands.
  std::shared_ptr<const LabelMap> takeEdited();
  // Such a copy, for a file: without rows that have no voxel either. Null without structures, or
  // memory for them.
  std::shared_ptr<const LabelMap> finished();
  bool isWall(int label) const { return label == structures_.wall(); }
  bool hasAny() const { return structures_.first() != 0; }  // but the wall

  // The one that tools work on: its label; 0: none.
  int current() const { return current_; }
  void setCurrent(int label);
  // Refuses a name that another has or that is empty, in words.
  Status rename(int label, const QString& name);
  bool setColour(int label, const Vec3& colour);  // false: it may not change now
  // A layer that was made of another (structure_shaping.h) goes back to that one.
  void remove(int label);

  struct Preview {
    int label = 0;
    double ml = 0.0;
    HuSpan hu;
    bool leaked = false;
    Vec3 seed_mm{0.0};
    double seed_off_mm = 0.0;  // beside it
  };
  // A structure that was grown and does not count yet.
  const std::optional<Preview>& preview() const { return preview_; }
  // Grows one from a place in it; instead of the preview, where there is one. It neither takes nor
  // passes what other structures have, the wall, and the box's faces.
  void growAt(Vec3 patient_mm, const QString& name, const GrowOptions& options = {});
  void takePreview();
  void leavePreview();
  // The box's sides along the two axes of a slice, which lies across `across` of the grid, between
  // two corners; the third side stays. A preview is grown anew.
  void limitTo(const Vec3& from_mm, const Vec3& to_mm, int across);
  void leaveBox();
  const std::optional<VoxelBox>& box() const { return box_; }
  std::optional<Vec3> boxSize_mm() const;  // along the grid's axes

  // A stroke of the brush over the slices; makes a structure of that name where none is current.
  void beginStroke(const Vec3& patient_mm, const Brush& brush, const QString& name);
  // One of the wall: a row of its own in the list, which holds growing back, and which neither an
  // exercise nor a file gets. A preview is grown anew at the stroke's end.
  void beginWall(const Vec3& patient_mm, const Brush& brush);
  void moveStroke(const Vec3& patient_mm);
  void endStroke();
  bool inStroke() const { return stroke_.has_value(); }

  std::optional<QString> undoText() const;  // what would be taken back
  std::optional<QString> redoText() const;
  void undo();
  void redo();

  // --- For tools that work on the whole map (structure_shaping.h) ---
  // Whether it may change now, which is said where it may not. A preview goes.
  bool begin();
  // On another thread. `take` gets what `work` made, on the window's, unless it failed, which is
  // said, or the case is gone by then.
  template <class Work, class Take>
  void inBackground(Work work, Take take) {
    using Made = std::invoke_result_t<Work&, const Progress&>;
    work_.run(std::move(work), [this, take, own = map()](Made made) {
      if (map() != own) return;
      if (!made) return sayNotMade(made.error());
      take(*std::move(made));
    });
  }
  // As a step, or part of the last one.
  void put(const QString& step, const Result<LabelEdit>& edit, bool joins = false);
  // The label of the structure of that name, which is made where there is none; 0: there are too
  // many, which is said. `like`: the tissue whose colour it takes where none is called as it is.
  int addStructure(const std::string& name, const std::string& like = {});
  // `wanted`, or with a number where another is called so.
  std::string freeName(const QString& wanted) const;
  const std::shared_ptr<const Volume>& volume() const { return volume_; }
  EditedStructures& structures() { return structures_; }

  bool busy() const { return work_.busy(); }
  void cancel() { work_.cancel(); }

 signals:
  void changed(const trephine::VoxelBox& box);  // voxels of the map
  void listChanged();                           // names, colours, mL, the current one
  void boxChanged();                            // that growing keeps to
  void stateChanged();                          // busy, preview, history, locked
  void progressed(double fraction, const QString& step);
  void said(const QString& words);
  void saidNoMore(const QString& words);  // they no longer hold
  void failed(const trephine::Error& error);

 private:
  struct Stroke {
    int label = 0;
    Brush brush;
    Vec3 last_mm{0.0};
    bool any = false;
  };
  bool mayChange();
  void changedRows();
  QString nameOf(int label) const;
  std::shared_ptr<LabelMap> withoutWall();
  void growAnew();
  void chooseAnother();
  void sayNotMade(const Error& error);
  void showGrown(const Growth& grown, const std::string& name, const Vec3& seed_mm);
  void stepped(const std::optional<VoxelBox>& box);  // of the history

  std::shared_ptr<const Volume> volume_;
  TissueSet tissues_;
  EditedStructures structures_;
  int current_ = 0;
  std::optional<Preview> preview_;
  GrowOptions grown_with_;  // of the preview
  struct Regrow {
    Vec3 seed_mm{0.0};
    QString name;
  };
  std::optional<Regrow> regrow_;  // once the wall's stroke ends
  std::optional<VoxelBox> box_;
  std::optional<Stroke> stroke_;
  QString locked_;
  std::uint64_t saved_ = 0;                 // the version() that a file has
  std::optional<std::uint64_t> taken_ = 0;  // the same; none: it was given back
  BackgroundTask work_;                     // last: joined before what it reads goes
};

}  // namespace trephine
