// What a SceneRenderer is made of. For the .cpp files that draw, alone: VTK's headers come with it.
#pragma once

#include <vtkCallbackCommand.h>
#include <vtkNew.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/canvas.h"
#include "render/card_drawing.h"
#include "render/carve_volume_mapper.h"
#include "render/composer.h"
#include "render/display_volume.h"
#include "render/level_of_detail.h"
#include "render/outline_drawing.h"
#include "render/scene_renderer.h"
#include "render/tool_drawing.h"
#include "render/view_camera.h"
#include "render/volume_pictures.h"

namespace trephine {

// Of the rays of one eye's picture: two of them in less than two frames of a headset.
constexpr double kEyeBudget_ms = 7.0;
constexpr double kFirstOfAnEye = 4.0;  // pixels between two rays, before any was timed

// What is drawn for one camera: its picture of the volume, and all that is put together over it.
// VTK only fills framebuffers of our own: one renderer the volume's, as many rays as asked for, the
// others that of the outline and that of the tools.
struct SceneRenderer::View {
  explicit View(Parts& shared) : of(shared) {}

  Parts& of;
  ViewCamera camera;
  VolumePictures pictures;
  Canvas scene;       // the volume over the background and the outline, in the view's size
  Canvas tool_layer;  // the outline alone, then tools alone: colour and depth
  bool scene_stale = true;
  bool moving = false;
  int width = 1;
  int height = 1;

  // ---- Pictures of the volume, and all that is put together: scene_pictures.cpp.
  // `spans`: what the picture spans each way, in the view's width and height.
  void place(vtkRenderer& in, const glm::dvec2& spans);
  // Into the framebuffer that is bound.
  void cast(const Canvas& into, const Span& span, const PixelRect& part, double ray_step);
  VolumePictures::Cast caster();
  void drawAt(double level);
  // True where the picture changed and is to be composed again; more may be left either way.
  bool work(double budget_ms);
  // Around the points, in the view's pixels.
  PixelRect around(const Vec3* points, std::size_t count, int margin) const;
  void cut(const VoxelBox& box);
  PixelRect partOf(const VoxelBox& box) const;
  void sendLabels(double budget_ms);
  // Of the volume; null before there is one.
  const Canvas* shownCanvas() const;
  // With letters and lines of the panel, or without.
  void compose(unsigned int framebuffer, bool with_cues);
  // The ray of that picture at a pixel of the view, which may lie beyond it.
  static glm::ivec2 rayAt(const glm::dvec2& pixel, const Canvas& shown, const Span& span);
  // The surface in the middle of the picture; the camera's focus where nothing is seen there.
  Vec3 inTheMiddle(const Canvas& shown, const Span& span) const;
  // What is shown now.
  Picture read(bool with_cues);
  void resize(int wide, int high);
  void release();

  // ---- Tools over the picture: scene_tools.cpp.
  // Of the view; none where they lie beside it.
  std::vector<PixelRect> partsOfTools() const;
  PixelRect partOfOutline() const;
  void drawOutline(const Canvas* shown, const Span& span);  // into `scene`
  void drawTools(unsigned int framebuffer, const Canvas* shown, const Span& span);
  // What a renderer shows in these parts of the view, where tissue leaves it visible.
  void drawSolids(vtkRenderer& solids, double opacity, const std::vector<PixelRect>& parts,
                  unsigned int framebuffer, const Canvas* shown, const Span& span);
  void addGuides(const Canvas& shown, const Span& span, ScreenLines& to) const;
};

// What all views draw, and with what.
struct SceneRenderer::Parts {
  vtkNew<vtkRenderer> renderer;  // of the volume
  vtkNew<vtkRenderer> outline_renderer;
  vtkNew<vtkRenderer> tool_renderer;
  vtkSmartPointer<vtkOpenGLRenderWindow> window;  // null while detached
  vtkNew<vtkCallbackCommand> context_asked;
  RenderHost host;
  bool hosted = false;

  std::shared_ptr<VolumeMirror> mirror = std::make_shared<VolumeMirror>();
  std::unique_ptr<VolumeMirror::Reader> news = std::make_unique<VolumeMirror::Reader>(mirror);
  GridGeometry place_shown;
  CarveVolume volume;
  TissueLooks looks;
  std::vector<std::string> visible;      // ids of the tissues that are drawn
  TissueSet seen_tissues;                // asSeen()
  std::optional<VoxelBox> seen_box;      // none: to be found anew
  std::optional<DisplayVolume> reduced;  // stands in for the mirror's on the graphics card
  std::shared_ptr<LabelMap> reduced_labels;
  Index3 reduction{1, 1, 1};
  bool labels_held = false;    // the last picture stays until other labels are there as a whole
  bool may_need_more = false;  // of what is fitted: it has labels now
  bool fitted = false;         // what is shown has been sent, or refused
  bool refused = false;        // and nothing is drawn of it
  Status refusal;
  int most_edge = 0;  // for tests: as if textures had no longer edges; negative: all are refused

  OutlineDrawing outline;
  ToolDrawing tools;
  std::vector<ToolView> tool_views;
  ScreenLines lines;

  Composer composer;
  CardDrawing cards;  // of eyes alone
  Canvas frame;  // pictures that are read back
  // What has been drawn once in this context, so that OpenGL has its shaders.
  struct Warm {
    bool background = false, volume = false, outline = false, tools = false, cards = false;
  } warm;
  View panel{*this};
  View eye{*this};  // of two, one after the other
  LevelOfDetail eye_level{kEyeBudget_ms, kFirstOfAnEye, kEyeBudget_ms};

  Parts();
  std::array<vtkRenderer*, 3> renderers() { return {renderer, outline_renderer, tool_renderer}; }

  void spoil() {
    spoilLooks();
    labels_held = false;  // who moves the camera wants to see it
  }
  void spoilLooks() {
    panel.pictures.spoil();
    panel.scene_stale = true;
  }

  const Volume& voxels() const { return mirror->volume(); }
  const VoxelBox& seenBox();
  bool drawsVolume() const { return !mirror->empty() && !refused; }

  // ---- Fitting the volume to the graphics card: scene_fitting.cpp.
  // All voxels, as many as the card takes; sent with the next picture.
  void show();
  void showReduced();
  void changed(const VoxelBox& box);
  void otherLabels();
  void labelsChanged(const VoxelBox& box);
  // Halves it until the card takes it.
  void fit();
  bool reduceAsNeeded();  // true where it has to be reduced more than it is

  // ---- scene_pictures.cpp.
  // OpenGL's state was changed behind VTK's back, by us and by the window's toolkit.
  void handToVtk(int width, int height);
  // Draws one thing that is shown for the first time, nowhere to be seen. False: nothing is left.
  bool warmUp();
  bool cold() const { return nextCold() != nullptr; }
  bool Warm::*nextCold() const;
  void release();
};

}  // namespace trephine
