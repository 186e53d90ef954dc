// What a carve journal should do, written the plain way: a list of strokes with their voxels, and a
// copy of everything at each mark.
#pragma once

#include <algorithm>
#include <map>
#include <vector>

#include "volume/carve_journal.h"

namespace trephine::test {

class CarveModel {
 public:
  struct Taken {
    std::size_t voxel;
    std::int16_t hu;
    int tissue_class;
  };
  struct Stroke {
    int arm;
    CarveJournal::Credits credits;
    std::vector<Taken> taken;
    double credit_before_undo = 0.0;
  };
  struct State {
    Voxels hu;
    std::vector<Stroke> standing;
    CarveJournal::Credits credits{};
    std::map<std::pair<int, int>, std::uint64_t> removed;
  };

  explicit CarveModel(const Volume& start) {
    now.hu = start.hu;
    marks.push_back(now);
  }

  void begin(int arm) {
    undone.clear();
    now.standing.push_back({arm, now.credits, {}, 0.0});
    open[arm] = now.standing.size() - 1;
  }
  void end(int arm) { open.erase(arm); }
  void erase(int arm, std::size_t voxel, int tissue_class) {
    if (now.hu[voxel] == kAirHu) return;
    now.standing[open.at(arm)].taken.push_back({voxel, now.hu[voxel], tissue_class});
    now.hu[voxel] = kAirHu;
    ++now.removed[{arm, tissue_class}];
  }
  void undo() {
    open.clear();
    Stroke stroke = now.standing.back();
    now.standing.pop_back();
    for (const Taken& taken : stroke.taken) {
      now.hu[taken.voxel] = taken.hu;
      --now.removed[{stroke.arm, taken.tissue_class}];
    }
    double& credit = now.credits[std::size_t(stroke.arm)];
    stroke.credit_before_undo = credit;
    credit = stroke.credits[std::size_t(stroke.arm)];
    undone.push_back(std::move(stroke));
  }
  void redo() {
    open.clear();
    const Stroke stroke = undone.back();
    undone.pop_back();
    for (const Taken& taken : stroke.taken) {
      now.hu[taken.voxel] = kAirHu;
      ++now.removed[{stroke.arm, taken.tissue_class}];
    }
    double& credit = now.credits[std::size_t(stroke.arm)];
    credit = std::min(credit, stroke.credit_before_undo);
    now.standing.push_back(stroke);
  }
  void rewind(std::size_t second) {
    open.clear();
    undone.clear();
    now = marks[second];
  }
  void mark() { marks.push_back(now); }

  State now;
  std::vector<State> marks;
  std::vector<Stroke> undone;
  std::map<int, std::size_t> open;  // by arm
};

}  // namespace trephine::test
