// Draws a case: the volume by ray casting, the tools, nothing else. VTK stays inside the .cpp.
//
// One thread, the window's. It owns no voxels: it draws those of a VolumeMirror, whose changes go
// to the GPU as dirty boxes only.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "base/eye_view.h"
#include "base/math.h"
#include "base/result.h"
#include "render/card.h"
#include "render/clip_plane.h"
#include "render/picture.h"
#include "render/screen_lines.h"
#include "render/view_camera.h"
#include "tissue/tissue_look.h"
#include "tissue/tissue_set.h"
#include "volume/volume_mirror.h"

namespace trephine {

enum class ToolShape { needle, blade, burr };

// A tool as it is drawn. The tool points along -z of its pose, its tip is the pose's position.
struct ToolView {
  Pose pose_mm;            // patient frame
  double length_mm = 0.0;  // of the working part (blade, burr) or shaft (needle)
  ToolShape shape = ToolShape::needle;
  bool contact = false;    // shown by a mark at the tip; the colour stays the arm's
  Vec3 colour{0.8};        // of the whole tool; with a mesh, of what lies behind length_mm
  double radius_mm = 0.0;  // of the needle, the burr's head, half the blade's thickness; 0: usual
  double head_mm = 0.0;    // of a burr's head that is a rod with round ends; 0: a ball
  // An STL file that is drawn instead of `shape`; where it cannot be, a warning says why, once.
  std::string mesh_file;
  Vec3 mesh_tip_mm{0.0};          // in the mesh's frame
  Vec3 mesh_axis{0.0, 0.0, 1.0};  // from the tip to the handle, in the mesh's frame
};

// Where the ray caster departs from VTK's, beside leaping over what is empty.
struct ShadingOptions {
  bool normals = true;  // shading follows the surface; off: VTK's central differences
  bool classes = true;  // a partial-volume edge shows none of the tissues it passes through
  friend bool operator==(const ShadingOptions&, const ShadingOptions&) = default;
};

// How the window lends its OpenGL context to VTK.
struct RenderHost {
  std::function<bool()> isCurrent;
  std::function<void()> makeCurrent;
};

class SceneRenderer {
 public:
  // For a window: call attach() once its context is current (initializeGL).
  SceneRenderer();
  // Its own hidden window, of this size. Errors: NO_DISPLAY (asked before VTK is touched),
  // NO_OPENGL.
  static Result<std::unique_ptr<SceneRenderer>> offscreen(int width, int height);
  ~SceneRenderer();
  SceneRenderer(const SceneRenderer&) = delete;
  SceneRenderer& operator=(const SceneRenderer&) = delete;

  // Errors: NO_OPENGL (older than 3.2), with what the driver says of itself.
  Status attach(RenderHost host);
  void detach();  // before the context goes
  std::string openGlDescription() const;
  // Of all screens together, in pixels; {0, 0} before there is a window.
  std::array<int, 2> screenSize() const;

  // Draws what this mirror holds from now on. The camera stays where the place in the patient is
  // the same. Full upload at the next paint.
  void setMirror(std::shared_ptr<VolumeMirror> mirror);
  // For a picture without a window: a mirror of the grid, of its own.
  void setVolume(const Grid& grid);
  // The same of a grid that no mirror has read from yet and that began as `whole`, which the caller
  // keeps: what was cut since is shown as cut.
  void setVolume(Grid& grid, const std::shared_ptr<const Volume>& whole);
  bool hasVolume() const;
  // A tissue of the set that is not visible is shown all the same where a look says so (asSeen).
  void setTissues(const TissueSet& tissues, const TissueLooks& looks = {});
  // At most kMostClipPlanes; what all of them leave is drawn, with a face where a plane cuts it.
  static constexpr std::size_t kMostClipPlanes = 8;
  void setClip(const std::vector<ClipPlane>& planes);
  // Where the light comes from: right, up, towards the eye. It is fixed to the eye. From a little
  // to the left and above at first, so that a hollow has a lit wall and a dark one.
  static inline const Vec3 kLight = glm::normalize(Vec3(-0.3, 0.4, 1.0));
  void setLight(const Vec3& from);
  void setShading(const ShadingOptions& options);
  // Distance of the samples of a ray at full quality, in the smallest edge of a voxel.
  // `trephine-lab trades` recommends the default, and ShadingOptions's.
  static constexpr double kSampleDistance = 0.5;
  void setSampleDistance(double voxels);
  // Takes what is new in the mirror; the boxes are sent at the next paint. True when there is
  // something new to draw.
  bool takeChanges();
  // The same after the mirror took what the grid's writer changed.
  bool pullChanges(Grid& grid);
  // What is on the screen.
  const Volume& copy() const;
  void setTools(const std::vector<ToolView>& tools);
  // A line on the tissue, until another is set; without points none. Hidden where tissue lies
  // before it, seen where it lies on a surface. Tools pass before it. Like them it costs no ray.
  void setOutline(const std::vector<Vec3>& points_mm, bool closed, double width_mm);

  void resize(int width, int height);  // device pixels
  // Fewer rays and longer steps while the camera moves; `true` at each input, `false` when still.
  void setMoving(bool moving);
  // Makes the picture of the volume where it is stale and renders into the framebuffer object that
  // the window shows. Tools alone are drawn over the last picture of the volume. With a budget, a
  // still picture that would take longer comes coarse at first; finer ones follow whole. False
  // while there is work for refine().
  bool paint(unsigned int framebuffer, double budget_ms = std::numeric_limits<double>::infinity());
  // The first time that something is drawn OpenGL makes its shader, which takes as long as several
  // frames: in a window, paint() with a budget leaves out what is cold until warmUp() has drawn it
  // where nobody sees it, one thing a call. False: nothing was left.
  bool cold() const;
  bool warmUp();
  // What one eye of two sees, without letters and lines, into a framebuffer object of this size, as
  // coarse as it has to be for pictures of a moving head. What is cold is left out.
  void paintEye(const EyeView& eye_mm, unsigned int framebuffer, int width, int height);
  // The same at full quality, read back.
  Picture eyePicture(const EyeView& eye_mm, int width, int height);
  // The last was drawn: what they needed goes.
  void releaseEyes();
  // What stands in such pictures to be read.
  void setCards(std::vector<Card> cards);
  // Works for about so long on a finer picture, where nothing of it is cold. True when there is
  // another to paint.
  bool refine(double budget_ms);
  bool complete() const;
  // The volume has no picture as it is to be seen now: the next paint makes one.
  bool stale() const;
  // How many voxels became one for the display, where the graphics card takes no more; {1, 1, 1}
  // where it shows all. Known once it is painted.
  Index3 reduction() const;
  // VOLUME_REFUSED where the graphics card cannot show the volume at all, NO_OPENGL where a picture
  // or a shader was refused. Known once it is painted.
  Status refusal() const;
  // Of the rays of full quality, those that the shown picture has; 0 before there is one.
  double shareOfRays() const;
  // Renders at full quality and reads it back.
  Picture picture();

  // Camera. `direction` points from the eye to the focus, patient frame. resetCamera() fits the
  // volume into the picture, showAll() what can be seen of it, as tissues and looks have it,
  // beside `covered` pixels at the left and at the right edge.
  void resetCamera(const Vec3& direction, const Vec3& up);
  void showAll(const Vec3& direction, const Vec3& up, int covered = 0);
  void lookAt(const Vec3& focus_mm, const Vec3& direction, const Vec3& up, double distance_mm);
  void orbit(double azimuth_deg, double elevation_deg);  // about the focus
  void orbit(double azimuth_deg, double elevation_deg, const Vec3& about_mm);
  void zoom(double factor);
  void pan(double dx_pixels, double dy_pixels);  // the picture moves right and down, as a mouse
  // Of the voxels that can be seen: the middle of the smallest box around them, patient frame, and
  // half of its diagonal [mm]. The volume's own where nothing can be seen.
  struct Seen {
    Vec3 middle_mm{0.0};
    double radius_mm = 0.0;
  };
  Seen seen() const;
  void setParallel(bool parallel);
  const ViewCamera& camera() const;
  // Over the picture, in its pixels, until others are set.
  void setLines(const ScreenLines& lines);
  // The view plane's axes in the patient frame, and the mm that one pixel spans at a point.
  Vec3 viewRight() const;
  Vec3 viewUp() const;
  Vec3 viewForward() const;
  double mmPerPixelAt(const Vec3& patient_mm) const;

 private:
  friend struct UploadProbe;
  struct Parts;
  struct View;
  std::unique_ptr<Parts> parts_;
};

// For measurements: of partial against full upload, in milliseconds until the GPU has it, and of
// leaping over empty space against VTK's own way. Only with an attached or offscreen renderer.
struct UploadProbe {
  // The texture alone.
  static double fullUpload_ms(SceneRenderer& renderer);
  // All that a cut costs before the next frame: the texture and what can be leapt over.
  static double boxUpload_ms(SceneRenderer& renderer, const VoxelBox& box);
  // The copy that will be uploaded, to be changed by the measurement.
  static Volume& copy(SceneRenderer& renderer);
  // As if the graphics card took no texture with a longer edge; negative: none at all. Before the
  // volume is painted.
  static void limitEdges(SceneRenderer& renderer, int most);
  static void setLeaping(SceneRenderer& renderer, bool on);
  // Each ray in the colour of the first tissue with an opacity over zero, opaque and without light:
  // what the picture says is there.
  static void setFirstTissue(SceneRenderer& renderer, bool on);
  // Each ray in the normal of its first visible sample, opaque and without light: red right, green
  // up, blue towards the eye, -1..1 as 0..255. Of VTK's own normals without
  // ShadingOptions::normals.
  static void setNormalsAsColour(SceneRenderer& renderer, bool on);
  // Pixels between two rays of the last moving picture, each way.
  static double level(const SceneRenderer& renderer);
  // A picture at that level instead of at full quality, read back.
  static Picture pictureAt(SceneRenderer& renderer, double level);
  // What the last paint drew, read back.
  static Picture painted(SceneRenderer& renderer);
};

}  // namespace trephine
