// VTK renamed its loader of OpenGL in 9.4. Before any other header that knows OpenGL.
#if __has_include(<vtk_glad.h>)
#include <vtk_glad.h>
#else
#include <vtk_glew.h>
#endif
//
#include <vtkCallbackCommand.h>
#include <vtkColorTransferFunction.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLGPUVolumeRayCastMapper.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPointData.h>
#include <vtkRenderer.h>
#include <vtkShaderProgram.h>
#include <vtkShaderProperty.h>
#include <vtkShortArray.h>
#include <vtkSmartPointer.h>
#include <vtkTextureObject.h>
#include <vtkVolume.h>
#include <vtkVolumeInputHelper.h>
#include <vtkVolumeProperty.h>
#include <vtkVolumeTexture.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "render/carve_volume_mapper.h"
#include "render/dirty_boxes.h"
#include "render/empty_space.h"

namespace trephine {

namespace {

// Reaches the texture that VTK's ray caster samples.
class CarveMapper : public vtkOpenGLGPUVolumeRayCastMapper {
 public:
  static CarveMapper* New();
  vtkTypeMacro(CarveMapper, vtkOpenGLGPUVolumeRayCastMapper);

  // Asked only after a draw: VTK keeps dead pointers in here once it released its resources. Null
  // where the GPU refused the volume.
  vtkTextureObject* texture() {
    const auto input = AssembledInputs.find(0);
    if (input == AssembledInputs.end() || !input->second.Texture) return nullptr;
    vtkTextureObject* texture = input->second.Texture->GetCurrentBlock()->TextureObject;
    return texture && texture->GetHandle() ? texture : nullptr;
  }
};
vtkStandardNewMacro(CarveMapper);

// Tells OpenGL how the rows of a grid lie in memory, for as long as this lives.
class UnpackRows {
 public:
  explicit UnpackRows(const Index3& size) {
    glGetIntegerv(GL_UNPACK_ALIGNMENT, &alignment_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, size[0]);
    glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, size[1]);
  }
  ~UnpackRows() {
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, 0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, alignment_);
  }
  UnpackRows(const UnpackRows&) = delete;
  UnpackRows& operator=(const UnpackRows&) = delete;

 private:
  GLint alignment_ = 4;
};

// Sends a part of `grid`, of this size, into a texture that holds all of it.
template <class Value>
void sendBox(vtkTextureObject& texture, const Value* grid, const Index3& size,
             const VoxelBox& box) {
  const auto [i, j, k] = box.low;
  const UnpackRows layout(size);
  texture.Activate();
  glTexSubImage3D(
      GL_TEXTURE_3D, 0, i, j, k, box.high[0] - i, box.high[1] - j, box.high[2] - k, GL_RED,
      sizeof(Value) == 1 ? GL_UNSIGNED_BYTE : GL_SHORT,
      grid + (std::size_t(k) * std::size_t(size[1]) + std::size_t(j)) * std::size_t(size[0]) +
          std::size_t(i));
}

static_assert(kLeapEdge == 8, "the shader below counts in bricks of 8");
constexpr char kLeapDeclarations[] = R"(//VTK::Base::Dec
uniform sampler3D in_leaps;  // bricks to the nearest visible one, as a byte
vec3 g_bricks;               // bricks per texture coordinate
vec3 g_start;
vec3 g_forward;
vec3 g_stepsPerBrick;
float g_lastT;
)";

// Where the ray leaves the box, in steps; the sample that VTK takes past the depth buffer stays in.
constexpr char kLeapStart[] = R"(//VTK::Terminate::Init
  g_bricks = vec3(textureSize(in_volume[0], 0)) / 8.0;
  g_start = g_dataPos;
  g_forward = step(vec3(0.0), g_dirStep);
  vec3 l_step = mix(min(g_dirStep, vec3(-1e-9)), max(g_dirStep, vec3(1e-9)), g_forward);
  g_stepsPerBrick = 1.0 / (l_step * g_bricks);
  vec3 l_exit = (mix(in_texMin[0], in_texMax[0], g_forward) - g_start) / l_step;
  g_lastT = min(g_terminatePointMax + 1.0, min(l_exit.x, min(l_exit.y, l_exit.z)));
)";

// Goes to the next sample that is not transparent: by whole steps, so that samples are taken where
// VTK would take them. A software rasteriser pays for shading whether or not a sample needs it,
// so transparent samples are passed here too. The condition also ends a ray that is not a number.
constexpr char kLeap[] = R"(//VTK::Base::Impl
    while (g_currentT <= g_lastT)
      {
      vec3 l_place = g_dataPos * g_bricks;
      vec3 l_brick = clamp(floor(l_place), vec3(0.0), vec3(textureSize(in_leaps, 0)) - 1.0);
      float l_free = floor(texelFetch(in_leaps, ivec3(l_brick), 0).r * 255.0 + 0.5);
      float l_steps = 1.0;
      if (l_free > 0.0)
        {
        vec3 l_face = l_brick + mix(vec3(1.0 - l_free), vec3(l_free), g_forward);
        vec3 l_t = (l_face - l_place) * g_stepsPerBrick;
        l_steps = max(1.0, ceil(min(l_t.x, min(l_t.y, l_t.z))));
        }
      else
        {
        float l_hu = texture3D(in_volume[0], g_dataPos).r;
        l_hu = l_hu * in_volume_scale[0].r + in_volume_bias[0].r;
        if (texture2D(in_opacityTransferFunc_0[0], vec2(l_hu, 0.0)).r > 0.0)
          {
          break;
          }
        }
      g_currentT += l_steps;
      g_dataPos = g_start + g_currentT * g_dirStep;
      }
    if (!(g_currentT <= g_lastT))
      {
      break;
      }
)";

}  // namespace

struct CarveVolume::Parts {
  vtkNew<CarveMapper> mapper;
  vtkNew<vtkVolume> prop;
  vtkNew<vtkVolumeProperty> look;
  vtkNew<vtkColorTransferFunction> colour;
  vtkNew<vtkPiecewiseFunction> opacity;
  vtkNew<vtkTextureObject> leaps;
  vtkNew<vtkCallbackCommand> shader_used;
  vtkNew<vtkCallbackCommand> draw_starts;
  vtkNew<vtkCallbackCommand> draw_ends;
  vtkOpenGLState* state = nullptr;  // of the window of the last sendChanges
  std::optional<std::pair<int, int>> rows;
  int width = 0;
  int height = 0;
  vtkSmartPointer<vtkImageData> image;
  Volume* copy = nullptr;
  std::vector<VoxelBox> boxes;
  std::vector<HuInterval> visible;
  BrickRanges bricks;
  LeapMap leap_map;
  double lookup_step_HU = 0.0;
  double half_voxel_mm = 0.5;
  bool leaping = true;
  bool sent = false;           // VTK's texture holds the copy, but for `boxes`
  bool leap_map_stale = true;  // to be made anew
  bool leaps_stale = true;     // to be sent

  // Leaves the texture active.
  void sendLeaps(vtkRenderer& renderer) {
    const Index3& n = bricks.size();
    if (leap_map_stale) leap_map = LeapMap(bricks, visible, 2.0 * lookup_step_HU);
    const std::uint8_t* distances = leap_map.distances().data();
    if (leap_map_stale || !leaps->GetHandle()) {
      const UnpackRows layout(n);
      leaps->SetContext(vtkOpenGLRenderWindow::SafeDownCast(renderer.GetRenderWindow()));
      leaps->SetMinificationFilter(vtkTextureObject::Nearest);
      leaps->SetMagnificationFilter(vtkTextureObject::Nearest);
      // VTK takes a pointer to what it only reads.
      leaps->Create3DFromRaw(unsigned(n[0]), unsigned(n[1]), unsigned(n[2]), 1, VTK_UNSIGNED_CHAR,
                             const_cast<std::uint8_t*>(distances));
    } else if (leaps_stale) {
      sendBox(*leaps, distances, n, {{0, 0, 0}, n});
    }
    leap_map_stale = leaps_stale = false;
    leaps->Activate();
  }

  // The rest of the picture is drawn whole: only rays cost time.
  void startDraw() {
    if (!rows) return;
    state->vtkglEnable(GL_SCISSOR_TEST);
    state->vtkglScissor(0, rows->first, width, rows->second - rows->first);
  }

  void endDraw() {
    sent = true;
    if (rows) state->vtkglScissor(0, 0, width, height);
  }

  void updateShader() {
    vtkShaderProperty* shader = prop->GetShaderProperty();
    shader->ClearAllFragmentShaderReplacements();
    if (!leaping) return;
    shader->AddFragmentShaderReplacement("//VTK::Base::Dec", true, kLeapDeclarations, false);
    shader->AddFragmentShaderReplacement("//VTK::Terminate::Init", true, kLeapStart, false);
    shader->AddFragmentShaderReplacement("//VTK::Base::Impl", true, kLeap, false);
  }
};

CarveVolume::CarveVolume() : parts_(std::make_unique<Parts>()) {
  Parts& p = *parts_;
  // Pictures are compared for equality, and a level of detail of our own is driven by frame time.
  p.mapper->SetUseJittering(0);
  p.mapper->SetAutoAdjustSampleDistances(0);
  p.mapper->SetBlendModeToComposite();
  p.shader_used->SetClientData(&p);
  p.shader_used->SetCallback([](vtkObject*, unsigned long, void* parts, void* program) {
    const int unit = static_cast<Parts*>(parts)->leaps->GetTextureUnit();
    static_cast<vtkShaderProgram*>(program)->SetUniformi("in_leaps", unit);
  });
  p.mapper->AddObserver(vtkCommand::UpdateShaderEvent, p.shader_used);
  p.draw_starts->SetClientData(&p);
  p.draw_starts->SetCallback([](vtkObject*, unsigned long, void* parts, void*) {
    static_cast<Parts*>(parts)->startDraw();
  });
  p.mapper->AddObserver(vtkCommand::VolumeMapperRenderStartEvent, p.draw_starts);
  p.draw_ends->SetClientData(&p);
  p.draw_ends->SetCallback(
      [](vtkObject*, unsigned long, void* parts, void*) { static_cast<Parts*>(parts)->endDraw(); });
  p.mapper->AddObserver(vtkCommand::VolumeMapperRenderEndEvent, p.draw_ends);
  p.look->SetColor(p.colour);
  p.look->SetScalarOpacity(p.opacity);
  p.look->SetScalarOpacityUnitDistance(1.0);  // a tissue's opacity is per mm
  p.look->SetInterpolationTypeToLinear();
  p.look->ShadeOn();
  p.look->SetAmbient(0.2);
  p.look->SetDiffuse(0.68);
  p.look->SetSpecular(0.1);
  p.look->SetSpecularPower(20.0);
  p.prop->SetMapper(p.mapper);
  p.prop->SetProperty(p.look);
  p.updateShader();
  setTransferFunction({});
}

CarveVolume::~CarveVolume() = default;

void CarveVolume::show(Volume& copy, vtkRenderer& renderer) {
  Parts& p = *parts_;
  const GridGeometry& g = copy.geometry;
  p.copy = &copy;
  p.boxes.clear();
  p.sent = false;
  p.bricks = BrickRanges(copy);
  p.leap_map_stale = true;

  vtkNew<vtkShortArray> voxels;
  voxels->SetArray(copy.hu.data(), vtkIdType(copy.hu.size()), 1 /* not VTK's to free */);
  // VTK spreads its lookup tables over the range of HU that it finds when it sends everything. A
  // range that carving can change would make a box's picture differ from the whole volume's, so
  // two voxels lend their place to fixed limits while VTK looks; it remembers the range.
  const BrickRanges::Range whole = p.bricks.whole();
  const std::int16_t low = std::min<std::int16_t>(whole.low, -1024);
  const std::int16_t high = std::max<std::int16_t>(whole.high, 3071);
  std::int16_t& first = copy.hu.front();
  std::int16_t& last = copy.hu.back();
  const std::pair kept(first, last);
  last = high;
  first = low;
  voxels->GetFiniteRange(0);
  last = kept.second;
  first = kept.first;
  p.lookup_step_HU = (double(high) - double(low)) / 1023.0;

  p.image = vtkSmartPointer<vtkImageData>::New();
  p.image->SetDimensions(g.size[0], g.size[1], g.size[2]);
  p.image->SetSpacing(g.spacing_mm.x, g.spacing_mm.y, g.spacing_mm.z);
  p.image->GetPointData()->SetScalars(voxels);
  p.mapper->SetInputData(p.image);

  // The image lies along its own axes; where those point in the patient is the prop's matrix.
  vtkNew<vtkMatrix4x4> place;
  for (int row = 0; row < 3; ++row) {
    for (int axis = 0; axis < 3; ++axis) place->SetElement(row, axis, g.direction[axis][row]);
    place->SetElement(row, 3, g.origin_mm[row]);
  }
  p.prop->SetUserMatrix(place);
  p.half_voxel_mm = 0.5 * std::min({g.spacing_mm.x, g.spacing_mm.y, g.spacing_mm.z});
  setQuality(1.0, 1.0);
  if (!renderer.HasViewProp(p.prop)) renderer.AddVolume(p.prop);
}

void CarveVolume::remove(vtkRenderer& renderer) {
  renderer.RemoveVolume(parts_->prop);
  parts_->mapper->RemoveAllInputs();
  parts_->image = nullptr;
  parts_->copy = nullptr;
  parts_->boxes.clear();
}

void CarveVolume::setTransferFunction(const std::vector<TransferPoint>& points) {
  Parts& p = *parts_;
  p.colour->RemoveAllPoints();
  p.opacity->RemoveAllPoints();
  for (const TransferPoint& point : points) {
    p.colour->AddRGBPoint(point.hu, point.colour.x, point.colour.y, point.colour.z);
    p.opacity->AddPoint(point.hu, point.opacity);
  }
  if (points.empty()) {  // VTK would make up a function of its own
    p.colour->AddRGBPoint(0.0, 0.0, 0.0, 0.0);
    p.opacity->AddPoint(0.0, 0.0);
  }
  p.visible = visibleIntervals(points);
  p.leap_map_stale = true;
}

void CarveVolume::changed(const VoxelBox& box) {
  parts_->boxes.push_back(box);
}

void CarveVolume::sendChanges(vtkRenderer& renderer) {
  Parts& p = *parts_;
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(renderer.GetRenderWindow());
  p.state = window->GetState();
  p.width = window->GetSize()[0];
  p.height = window->GetSize()[1];
  if (!p.copy) return;
  const std::vector<VoxelBox> boxes = mergeBoxes(std::exchange(p.boxes, {}));
  // Unless VTK is about to send everything.
  vtkTextureObject* texture = p.sent ? p.mapper->texture() : nullptr;
  for (const VoxelBox& box : boxes) {
    if (const std::optional<BrickBox> bricks = p.bricks.update(*p.copy, box)) {
      if (!p.leap_map_stale) p.leap_map.update(p.bricks, *bricks);
      p.leaps_stale = true;
    }
    if (texture) sendBox(*texture, p.copy->hu.data(), p.copy->geometry.size, box);
  }
  if (texture) texture->Deactivate();
  // Takes the first texture unit before VTK takes any: a sampler's value is 0 until it is set, and
  // VTK raises no UpdateShaderEvent in the frame that builds a shader.
  p.sendLeaps(renderer);
}

void CarveVolume::scan(vtkRenderer& renderer) {
  Parts& p = *parts_;
  if (!p.copy) return;
  p.bricks = BrickRanges(*p.copy);
  p.leap_map_stale = true;
  p.sendLeaps(renderer);
}

bool CarveVolume::sendAll(vtkRenderer& renderer) {
  Parts& p = *parts_;
  if (!p.copy) return false;
  p.boxes.clear();
  p.image->Modified();
  p.sent = p.mapper->PreLoadData(&renderer, p.prop);
  return p.sent;
}

void CarveVolume::setQuality(double pixel_step, double ray_step) {
  Parts& p = *parts_;
  p.mapper->SetImageSampleDistance(float(pixel_step));
  p.mapper->SetSampleDistance(float(ray_step * p.half_voxel_mm));
}

void CarveVolume::setRows(std::optional<std::pair<int, int>> rows) {
  parts_->rows = rows;
}

void CarveVolume::setLeaping(bool on) {
  parts_->leaping = on;
  parts_->updateShader();
}

void CarveVolume::releaseGraphics(vtkRenderer& renderer) {
  vtkWindow* window = renderer.GetRenderWindow();
  parts_->sent = false;
  parts_->prop->ReleaseGraphicsResources(window);
  parts_->leaps->ReleaseGraphicsResources(window);
}

}  // namespace trephine
