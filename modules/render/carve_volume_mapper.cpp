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
#include <vtkVolume.h>
#include <vtkVolumeInputHelper.h>
#include <vtkVolumeProperty.h>
#include <vtkVolumeTexture.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "render/carve_volume_mapper.h"
#include "render/cut_marks.h"
#include "render/dirty_boxes.h"
#include "render/empty_space.h"
#include "render/label_sender.h"
#include "render/ray_shading.h"
#include "render/send_box.h"

namespace trephine {

namespace {

// Reaches the texture that VTK's ray caster samples.
class CarveMapper : public vtkOpenGLGPUVolumeRayCastMapper {
 public:
  static CarveMapper* New();
  vtkTypeMacro(CarveMapper, vtkOpenGLGPUVolumeRayCastMapper);

  // VTK's first draw lets go of what was loaded before it, only to load it again: a whole volume.
  // While a draw has begun, what is there stays.
  void ReleaseGraphicsResources(vtkWindow* window) override {
    if (!drawing) Superclass::ReleaseGraphicsResources(window);
  }
  bool drawing = false;

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
  vtkNew<vtkCallbackCommand> complained;
  std::string complaint;
  vtkOpenGLState* state = nullptr;  // of the window of the last sendChanges
  PixelRect part;
  vtkNew<vtkTextureObject> no_depth;  // one pixel: nothing ends a ray
  vtkSmartPointer<vtkImageData> image;
  Volume* copy = nullptr;
  const VolumeMirror* mirror = nullptr;  // what was cut
  Index3 factors{1, 1, 1};               // of the mirror's voxels in one of the copy
  std::int16_t mark = kAirHu;            // HU of removed voxels on the graphics card
  std::shared_ptr<const LabelMap> labels;
  std::vector<VoxelBox> boxes;
  LabelRows label_rows;
  std::vector<std::vector<TransferPoint>> looks{{}};  // of each row
  std::vector<std::vector<HuInterval>> visible;       // of each row
  RayShading shading;
  BrickRanges bricks;
  EmptySpaceDistance empty_space_distance;
  double lookup_step_HU = 0.0;
  double smallest_edge_mm = 1.0;                            // of a voxel
  double sample_distance = SceneRenderer::kSampleDistance;  // at full quality, in that edge
  bool sent = false;   // VTK's texture holds the copy, but for `boxes`
  bool drawn = false;  // VTK sends all once more when it draws for the first time
  std::optional<CutMarks> marks_of_all;
  bool empty_space_stale = true;  // to be made anew
  bool leaps_stale = true;     // to be sent
  LabelSender sender;          // of the labels
  bool kind_stale = true;      // the texture is to be made anew, with or without labels
  bool rows_stale = true;      // of labels, to be sent

  // Looks that are told apart: without a label map all voxels are of the first row.
  std::size_t rowCount() const { return labels ? looks.size() : 1; }

  // Leaves the texture active. Labels that are to be sent follow with sendLabels().
  void sendLeaps(vtkRenderer& renderer) {
    const Index3& n = bricks.size();
    const bool by_label = rowCount() > 1;
    const bool anew = kind_stale || !leaps->GetHandle() || (empty_space_stale && !by_label);
    if (anew && by_label) sender.start(labels);
    if (empty_space_stale) {
      std::vector<std::uint32_t> rows;
      if (by_label) rows = sender.bricks().rows(label_rows);
      empty_space_distance =
          EmptySpaceDistance(bricks, visible, std::move(rows), 2.0 * lookup_step_HU);
    }
    const std::uint8_t* distances = empty_space_distance.distances().data();
    if (anew) {
      leaps->SetContext(vtkOpenGLRenderWindow::SafeDownCast(renderer.GetRenderWindow()));
      leaps->ResetFormatAndType();                             // one or two bytes
      leaps->SetMinificationFilter(vtkTextureObject::Linear);  // of labels; leaps are fetched
      leaps->SetMagnificationFilter(vtkTextureObject::Linear);
    }
    if (anew && by_label) {
      const Index3& size = copy->geometry.size;
      leaps->Create3DFromRaw(unsigned(size[0]), unsigned(size[1]),
                             unsigned(size[2] + n[2] + rowSlices()), 2, VTK_UNSIGNED_CHAR, nullptr);
    }
    if (anew && !by_label) {
      const UnpackRows layout(n);
      // VTK takes a pointer to what it only reads.
      leaps->Create3DFromRaw(unsigned(n[0]), unsigned(n[1]), unsigned(n[2]), 1, VTK_UNSIGNED_CHAR,
                             const_cast<std::uint8_t*>(distances));
    } else if (anew || empty_space_stale || leaps_stale) {
      sendBox(*leaps, distances, n, {{0, 0, 0}, n}, by_label ? copy->geometry.size[2] : 0);
    }
    if (by_label && (anew || rows_stale)) sendRows();
    empty_space_stale = leaps_stale = kind_stale = rows_stale = false;
    leaps->Activate();
  }

  // The row of each label, in the slices above the leaps.
  int rowSlices() const {
    const Index3& size = copy->geometry.size;
    return (256 + size[0] * size[1] - 1) / (size[0] * size[1]);
  }
  void sendRows() {
    const Index3& size = copy->geometry.size;
    const Index3 above{size[0], size[1], rowSlices()};
    std::vector<std::uint8_t> row(std::size_t(size[0]) * std::size_t(size[1]) *
                                  std::size_t(above[2]));
    std::ranges::copy(label_rows.row, row.begin());
    sendBox(*leaps, row.data(), above, {{0, 0, 0}, above}, size[2] + bricks.size()[2]);
  }

  // After labels in this box were sent: what can be leapt over there. One of much is quicker anew.
  void useLabels(const VoxelBox& box) {
    constexpr std::size_t kMany = 4096;  // bricks
    BrickBox of;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      of.low[axis] = box.low[axis] / kLeapEdge;
      of.high[axis] = std::min(bricks.size()[axis], (box.high[axis] - 1) / kLeapEdge + 1);
    }
    if (empty_space_stale || voxelCount(of) > kMany) {
      empty_space_stale = true;
      return;
    }
    for (int k = of.low[2]; k < of.high[2]; ++k) {
      for (int j = of.low[1]; j < of.high[1]; ++j) {
        for (int i = of.low[0]; i < of.high[0]; ++i) {
          const std::size_t brick = bricks.indexOf(i, j, k);
          empty_space_distance.setRows(brick, sender.bricks().rowsOf(brick, label_rows));
        }
      }
    }
    empty_space_distance.update(bricks, of);
    leaps_stale = true;
  }

  // Tells VTK the colours and what is visible.
  void updateLooks() {
    const std::size_t count = rowCount();
    std::vector<TransferPoint> points = looks[0];
    if (count > 1) points = sideBySide(looks, shading.low_HU, shading.high_HU);
    colour->RemoveAllPoints();
    opacity->RemoveAllPoints();
    for (const TransferPoint& point : points) {
      colour->AddRGBPoint(point.hu, point.colour.x, point.colour.y, point.colour.z);
      opacity->AddPoint(point.hu, point.opacity);
    }
    if (points.empty()) {  // VTK would make up a function of its own
      colour->AddRGBPoint(0.0, 0.0, 0.0, 0.0);
      opacity->AddPoint(0.0, 0.0);
    }
    // VTK makes its tables as fine as the two nearest points need, and at least 1024 wide.
    const double entries = std::min(1024.0 * double(count), 8192.0);
    const double share_HU =
        (shading.high_HU - shading.low_HU) * double(count) / (1.0 - 2.0 * kSideMargin);
    lookup_step_HU = (count > 1 ? share_HU : shading.high_HU - shading.low_HU) / (entries - 1.0);
    if (count > 1) {
      const TransferPoint& first = points.front();
      const double near_HU = first.hu - (shading.high_HU - shading.low_HU) / entries;
      colour->AddRGBPoint(near_HU, first.colour.x, first.colour.y, first.colour.z);
      opacity->AddPoint(near_HU, first.opacity);
    }
    setMark();
    visible.clear();
    for (std::size_t row = 0; row < count; ++row) visible.push_back(visibleIntervals(looks[row]));
    empty_space_stale = true;
    buildShader();
  }

  // Where a tissue that is seen holds the mark too, what was cut would be seen: then there is none.
  void setMark() {
    if (!copy) return;
    const std::int16_t before = mark;
    mark = cutMark(bricks.whole().low);
    const double looked_up = std::max(double(mark), shading.low_HU);
    for (std::size_t row = 0; row < rowCount(); ++row) {
      if (evaluate(looks[row], looked_up).opacity > 0.0) mark = kAirHu;
    }
    const VoxelBox cuts = boxOfCuts(*mirror, factors);
    if (mark != before && voxelCount(cuts) > 0) boxes.push_back(cuts);
  }

  // Until VTK has sent everything.
  void markAll() {
    marks_of_all.emplace(*copy, VoxelBox{{0, 0, 0}, copy->geometry.size}, *mirror, factors, mark);
  }

  void startDraw() {
    mapper->drawing = sent;
    if (!drawn) markAll();
    if (part.empty()) return;
    state->vtkglEnable(GL_SCISSOR_TEST);
    state->vtkglScissor(part.low_x, part.low_y, part.width(), part.height());
  }

  void endDraw() {
    mapper->drawing = false;
    marks_of_all.reset();
    sent = drawn = true;
  }

  void buildShader() {
    shading.rows = rowCount();
    shading.geometry = copy ? &copy->geometry : nullptr;
    shading.build(*prop->GetShaderProperty());
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
  p.complained->SetClientData(&p);
  p.complained->SetCallback([](vtkObject*, unsigned long, void* parts, void* text) {
    std::string& complaint = static_cast<Parts*>(parts)->complaint;
    if (complaint.empty()) complaint = text ? static_cast<const char*>(text) : "unknown";
  });
  p.mapper->AddObserver(vtkCommand::ErrorEvent, p.complained);
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
  p.updateLooks();
}

CarveVolume::~CarveVolume() = default;

void CarveVolume::show(Volume& copy, std::shared_ptr<const LabelMap> labels,
                       const VolumeMirror& mirror, const Index3& factors, vtkRenderer& renderer) {
  Parts& p = *parts_;
  const GridGeometry& g = copy.geometry;
  p.copy = &copy;
  p.labels = std::move(labels);
  p.mirror = &mirror;
  p.factors = factors;
  p.kind_stale = true;
  p.boxes.clear();
  p.complaint.clear();
  p.sent = p.drawn = false;
  p.bricks = BrickRanges(copy);

  // VTK spreads its lookup tables over the range of HU that it finds when it sends everything. A
  // range that carving can change would make a box's picture differ from the whole volume's, so
  // VTK is shown fixed limits instead; it remembers them, and does not read every voxel.
  const BrickRanges::Range whole = p.bricks.whole();
  const std::int16_t low = std::min<std::int16_t>(whole.low, -1024);
  const std::int16_t high = std::max<std::int16_t>(whole.high, 3071);
  vtkNew<vtkShortArray> voxels;
  std::array<std::int16_t, 2> limits{low, high};
  voxels->SetArray(limits.data(), 2, 1 /* not VTK's to free */);
  voxels->GetFiniteRange(0);
  voxels->SetArray(copy.hu.data(), vtkIdType(copy.hu.size()), 1);
  p.shading.low_HU = low;
  p.shading.high_HU = high;
  p.updateLooks();

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
  p.smallest_edge_mm = std::min({g.spacing_mm.x, g.spacing_mm.y, g.spacing_mm.z});
  setQuality(1.0, 1.0);
  if (!renderer.HasViewProp(p.prop)) renderer.AddVolume(p.prop);
}

void CarveVolume::remove(vtkRenderer& renderer) {
  renderer.RemoveVolume(parts_->prop);
  parts_->mapper->RemoveAllInputs();
  parts_->image = nullptr;
  parts_->copy = nullptr;
  parts_->mirror = nullptr;
  parts_->shading.geometry = nullptr;
  parts_->labels = nullptr;
  parts_->boxes.clear();
}

void CarveVolume::setTissues(const TissueSet& seen, const TissueLooks& looks) {
  Parts& p = *parts_;
  const LabelRows rows(tissueTable(seen));
  const bool by_label = p.rowCount() > 1;
  p.rows_stale |= rows.row != p.label_rows.row;
  p.label_rows = rows;
  p.looks.clear();
  p.shading.seen = seen;
  p.shading.looks = looks;
  for (int row = 0; row < p.label_rows.count; ++row) {
    p.looks.push_back(transferFunction(p.shading.seen, p.label_rows.label[std::size_t(row)]));
  }
  p.kind_stale |= by_label != (p.rowCount() > 1);
  p.updateLooks();
}

void CarveVolume::setLabels(std::shared_ptr<const LabelMap> labels) {
  Parts& p = *parts_;
  const bool by_label = p.rowCount() > 1;
  p.labels = std::move(labels);
  if (by_label != (p.rowCount() > 1)) {
    p.kind_stale = true;
    p.updateLooks();
  } else if (by_label) {
    p.sender.start(p.labels);
  }
}

void CarveVolume::labelsChanged(const VoxelBox& box) {
  if (parts_->labels && parts_->rowCount() > 1) parts_->sender.add(box);
}

bool CarveVolume::labelsSent() const {
  const Parts& p = *parts_;
  return !p.copy || p.rowCount() < 2 || (p.sender.done() && !p.kind_stale);
}

std::vector<VoxelBox> CarveVolume::sendLabels(vtkRenderer& renderer, double budget_ms) {
  Parts& p = *parts_;
  if (labelsSent()) return {};
  p.sendLeaps(renderer);  // the texture, where there is none yet
  const std::vector<VoxelBox> sent = p.sender.send(*p.leaps, budget_ms);
  for (const VoxelBox& box : sent) p.useLabels(box);
  return sent;
}

void CarveVolume::changed(const VoxelBox& box) {
  parts_->boxes.push_back(box);
}

void CarveVolume::sendChanges(vtkRenderer& renderer) {
  Parts& p = *parts_;
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(renderer.GetRenderWindow());
  p.state = window->GetState();
  if (!p.copy) return;
  const bool marked = p.mark != kAirHu && voxelCount(boxOfCuts(*p.mirror, p.factors)) > 0;
  p.shading.cut_HU = marked ? std::optional<double>(p.mark) : std::nullopt;
  p.shading.tellView(*p.prop->GetShaderProperty());
  const std::vector<VoxelBox> boxes = mergeBoxes(std::exchange(p.boxes, {}));
  // Unless VTK is about to send everything.
  vtkTextureObject* texture = p.sent ? p.mapper->texture() : nullptr;
  for (const VoxelBox& box : boxes) {
    if (const std::optional<BrickBox> bricks = p.bricks.update(*p.copy, box)) {
      if (!p.empty_space_stale) p.empty_space_distance.update(p.bricks, *bricks);
      p.leaps_stale = true;
    }
    if (!texture) continue;
    const CutMarks marks(*p.copy, box, *p.mirror, p.factors, p.mark);
    sendBox(*texture, p.copy->hu.data(), p.copy->geometry.size, box);
  }
  if (texture) texture->Deactivate();
  // Takes the first texture unit before VTK takes any: a sampler's value is 0 until it is set, and
  // VTK raises no UpdateShaderEvent in the frame that builds a shader.
  p.sendLeaps(renderer);
  // Tools are drawn into the picture later, so VTK need not copy a depth buffer for each.
  if (!p.no_depth->GetHandle()) {
    float far = 1.0F;
    p.no_depth->SetContext(window);
    p.no_depth->CreateDepthFromRaw(1, 1, vtkTextureObject::Float32, VTK_FLOAT, &far);
    p.mapper->SetSharedDepthTexture(p.no_depth);
  }
  p.no_depth->Activate();
}

void CarveVolume::scan(vtkRenderer& renderer) {
  Parts& p = *parts_;
  if (!p.copy) return;
  p.bricks = BrickRanges(*p.copy);
  p.empty_space_stale = true;
  p.sendLeaps(renderer);
}

bool CarveVolume::sendAll(vtkRenderer& renderer) {
  Parts& p = *parts_;
  if (!p.copy) return false;
  p.boxes.clear();
  p.image->Modified();
  while (glGetError() != GL_NO_ERROR) {  // of others
  }
  p.markAll();
  p.sent = p.mapper->PreLoadData(&renderer, p.prop) && glGetError() == GL_NO_ERROR &&
           p.mapper->texture();
  p.marks_of_all.reset();
  return p.sent;
}

const std::string& CarveVolume::complaint() const {
  return parts_->complaint;
}

void CarveVolume::setQuality(double pixel_step, double ray_step) {
  Parts& p = *parts_;
  p.shading.coarse = ray_step > 1.0;
  p.mapper->SetImageSampleDistance(float(pixel_step));
  p.mapper->SetSampleDistance(float(ray_step * p.sample_distance * p.smallest_edge_mm));
}

void CarveVolume::setPart(const PixelRect& part) {
  parts_->part = part;
}

void CarveVolume::setLeaping(bool on) {
  parts_->shading.leaping = on;
  parts_->buildShader();
}

void CarveVolume::setClip(const std::vector<ClipPlane>& planes) {
  parts_->shading.clip = planes;
}

void CarveVolume::setLight(const Vec3& from) {
  parts_->shading.light = from;
}

void CarveVolume::setShading(const ShadingOptions& options) {
  parts_->shading.options = options;
  parts_->buildShader();
}

void CarveVolume::setSampleDistance(double voxels) {
  parts_->sample_distance = voxels;
}

void CarveVolume::setFirstTissue(bool on) {
  parts_->shading.shows = on ? 1 : 0;
  parts_->buildShader();
}

void CarveVolume::setNormalsAsColour(bool on) {
  parts_->shading.shows = on ? 2 : 0;
  parts_->buildShader();
}

void CarveVolume::lookFrom(const Vec3& right, const Vec3& up, const Vec3& forward) {
  parts_->shading.eye_right = right;
  parts_->shading.eye_up = up;
  parts_->shading.eye_forward = forward;
}

void CarveVolume::releaseGraphics(vtkRenderer& renderer) {
  vtkWindow* window = renderer.GetRenderWindow();
  parts_->sent = parts_->drawn = false;
  parts_->prop->ReleaseGraphicsResources(window);
  parts_->leaps->ReleaseGraphicsResources(window);
  parts_->no_depth->ReleaseGraphicsResources(window);
}

}  // namespace trephine
