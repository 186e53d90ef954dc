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
#include "render/carve_volume_mapper.h"
#include "render/composer.h"
#include "render/display_volume.h"
#include "render/outline_drawing.h"
#include "render/scene_renderer.h"
#include "render/tool_drawing.h"
#include "render/view_camera.h"
#include "render/volume_pictures.h"

namespace trephine {

// VTK only fills framebuffers of our own: one renderer the volume's, as many rays as asked for, the
// others that of the outline and that of the tools. The picture is put together from them.
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

  ViewCamera camera;
  VolumePictures pictures;
  Composer composer;
  Canvas scene;       // the volume over the background and the outline, in the window's size
  Canvas tool_layer;  // the outline alone, then tools alone: colour and depth
  Canvas frame;       // pictures that are read back
  bool scene_stale = true;
  // What has been drawn once in this context, so that OpenGL has its shaders.
  struct Warm {
    bool background = false, volume = false, outline = false, tools = false;
  } warm;
  bool moving = false;
  int width = 1;
  int height = 1;

  Parts();
  std::array<vtkRenderer*, 3> renderers() { return {renderer, outline_renderer, tool_renderer}; }

  void spoil() {
    spoilLooks();
    labels_held = false;  // who moves the camera wants to see it
  }
  void spoilLooks() {
    pictures.spoil();
    scene_stale = true;
  }

  const Volume& voxels() const { return mirror->volume(); }
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

  // ---- Pictures of the volume, and all that is put together: scene_pictures.cpp.
  // `upwards`: what the picture spans upwards, in the window's height.
  void place(vtkRenderer& in, double upwards);
  // OpenGL's state was changed behind VTK's back, by us and by the window's toolkit.
  void handToVtk();
  // Into the framebuffer that is bound.
  void cast(const Canvas& into, const Span& span, const PixelRect& part, double ray_step);
  VolumePictures::Cast caster();
  void drawAt(double level);
  bool work(double budget_ms);
  // Around the points, in the window's pixels.
  PixelRect around(const Vec3* points, std::size_t count, int margin) const;
  void cut(const VoxelBox& box);
  PixelRect partOf(const VoxelBox& box) const;
  void sendLabels(double budget_ms);
  // Of the volume; null before there is one.
  const Canvas* shownCanvas() const {
    return drawsVolume() && pictures.pixelStep() > 0.0 ? &pictures.canvas() : nullptr;
  }
  void compose(unsigned int framebuffer);
  // The ray of that picture at a pixel of the window, which may lie beyond it.
  static glm::ivec2 rayAt(const glm::dvec2& pixel, const Canvas& shown, const Span& span);
  // The surface in the middle of the picture; the camera's focus where nothing is seen there.
  Vec3 inTheMiddle(const Canvas& shown, const Span& span) const;
  // Draws one thing that is shown for the first time, nowhere to be seen. False: nothing is left.
  bool warmUp();
  bool cold() const { return nextCold() != nullptr; }
  bool Warm::*nextCold() const;
  // What is shown now.
  Picture read();
  void release();

  // ---- Tools over the picture: scene_tools.cpp.
  // Of the window; none where they lie beside it.
  std::vector<PixelRect> partsOfTools() const;
  PixelRect partOfOutline() const;
  void drawOutline(const Canvas* shown, const Span& span);  // into `scene`
  void drawTools(unsigned int framebuffer, const Canvas* shown, const Span& span);
  // What a renderer shows in these parts of the window, where tissue leaves it visible.
  void drawSolids(vtkRenderer& solids, double opacity, const std::vector<PixelRect>& parts,
                  unsigned int framebuffer, const Canvas* shown, const Span& span);
  void addGuides(const Canvas& shown, const Span& span, ScreenLines& to) const;
};

}  // namespace trephine
