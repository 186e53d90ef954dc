// The structures of the open case while a person makes and mends them. No widget: it holds the
// label map that all views show meanwhile, its history, and the work in the background; the panel
// and the slices tell it what to do.
//
// Everything is on the window's thread but growing and what else takes over a second, which only
// reads the map; while that runs (busy()) nothing else is changed.
#pragma once

#include <QObject>
#include <QString>
#include <map>
#include <memory>
#include <optional>

#include "exercise/structure_view.h"
#include "structures/edit_history.h"
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
  std::shared_ptr<const LabelMap> map() const { return map_ ? map_ : given_; }
  double millilitres(int label) const { return ml_[std::size_t(label)]; }
  // Since setCase() or markSaved().
  bool edited() const { return edited_; }
  // What was saved is as it was after so many changes.
  std::uint64_t changes() const { return changes_; }
  void markSaved(std::uint64_t changes) { edited_ = edited_ && changes != changes_; }
  // What was taken last could not be used: it is there to be taken again.
  void giveBack() { untaken_ = map_ != nullptr; }
  bool isOf(const std::shared_ptr<const Volume>& volume) const { return volume_ == volume; }
  // Since setCase() or the last call; a copy of the map then, without the wall, else null. Not
  // while a preview stands.
  std::shared_ptr<const LabelMap> takeEdited();
  // Such a copy, for a file: without rows that have no voxel either. Null without structures, or
  // memory for them.
  std::shared_ptr<const LabelMap> finished();
  int wall() const { return wall_; }  // its label; 0: none was painted

  // The one that tools work on: its label; 0: none.
  int current() const { return current_; }
  void setCurrent(int label);
  // Refuses a name that another has or that is empty, in words.
  Status rename(int label, const QString& name);
  bool setColour(int label, const Vec3& colour);  // false: it may not change now
  // A layer that was made of another (makeShell) goes back to that one.
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

  // Skull and skin, as structures of those names; what had these names is replaced.
  void makeSkull();
  void makeSkin(double thickness_mm);
  // The outermost layer of the current one becomes a structure of that name.
  void makeShell(double thickness_mm, const QString& name);
  void fillHoles();
  void smooth(double radius_mm);
  void keepPieceAt(const Vec3& patient_mm);

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
  bool makeOwn();
  const Structure* structure(int label) const;
  std::shared_ptr<LabelMap> withoutWall();
  void touched();
  Labels overWall() const;
  void growAnew();
  // `like`: the tissue whose colour it takes where none is called as it is.
  int addStructure(const std::string& name, const std::string& like = {});
  std::string freeName(const QString& wanted) const;
  std::string spareName(const std::string& base) const;
  void chooseAnother();
  QString wordsIfThin(double thickness_mm) const;
  void sayMade(const QString& more);
  void put(const std::string& step, const Result<LabelEdit>& edit, bool joins = false);
  void applied(const LabelEdit& edit, bool added);
  void count(const LabelEdit& edit, bool added);
  void countAll();
  template <class Work, class Take>
  void inBackground(Work work, Take take);
  template <class Make>
  void editInBackground(Make make, const QString& step);
  void showGrown(const Growth& grown, const std::string& name, const Vec3& seed_mm);
  void stepped(const std::optional<VoxelBox>& box);  // of the history
  // A mask of 0 and 1 as a structure of that name, which is made or replaced.
  void putMask(const std::vector<std::uint8_t>& mask, const std::string& name,
               const std::string& like);

  std::shared_ptr<const Volume> volume_;
  TissueSet tissues_;
  std::shared_ptr<const LabelMap> given_;  // the case's, until something is changed
  std::shared_ptr<LabelMap> map_;
  std::array<double, 256> ml_{};
  EditHistory history_;
  int current_ = 0;
  std::optional<Preview> preview_;
  LabelEdit preview_edit_;
  bool preview_has_new_row_ = false;
  GrowOptions grown_with_;  // of the preview
  int wall_ = 0;
  std::map<int, int> shell_of_;  // by the layer's label: whose it is
  struct Regrow {
    Vec3 seed_mm{0.0};
    QString name;
  };
  std::optional<Regrow> regrow_;  // once the wall's stroke ends
  std::optional<VoxelBox> box_;
  std::optional<Stroke> stroke_;
  QString locked_;
  bool edited_ = false, untaken_ = false;
  std::uint64_t changes_ = 0;
  BackgroundTask work_;  // last: joined before what it reads goes
};

}  // namespace trephine
