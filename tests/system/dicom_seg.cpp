// DICOM segmentations for a script to compare: what is written, and what is read.
//
//   dicom_seg write FOLDER LABELS
//   dicom_seg read FILE THRESHOLD LAYERS
//
// `write` paints a CT and structures on an oblique grid, writes both into FOLDER and the labels, a
// byte a voxel, into LABELS. `read` writes a segmentation's layers into LAYERS, one after the
// other. Both print the grid and the structures as one JSON object, or an "error".
#include <fstream>
#include <iostream>
#include <string>

#include "base/json.h"
#include "imaging/dicom/seg_reader.h"
#include "imaging/dicom/seg_writer.h"

namespace trephine {

namespace {

Json vectorJson(const Vec3& v) {
  return Json::array({v.x, v.y, v.z});
}

Json gridJson(const GridGeometry& g) {
  return {{"size", g.size},
          {"spacing_mm", vectorJson(g.spacing_mm)},
          {"origin_mm", vectorJson(g.origin_mm)},
          {"axes",
           {vectorJson(g.direction[0]), vectorJson(g.direction[1]), vectorJson(g.direction[2])}}};
}

Json errorJson(const Error& error) {
  return {{"error", error.code.str()}, {"sentence", error.sentence()}};
}

bool save(const std::string& file, const std::vector<std::uint8_t>& bytes, bool append) {
  std::ofstream out(file, append ? std::ios::binary | std::ios::app : std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  out.flush();
  return bool(out);
}

Json write(const std::string& folder, const std::string& labels_file) {
  Volume ct;
  GridGeometry& g = ct.geometry;
  g.size = {37, 29, 17};  // frames that end within a byte
  g.spacing_mm = {0.7, 0.8, 1.25};
  g.origin_mm = {-31.5, 12.25, -140.0};
  const Vec3 i = glm::normalize(Vec3(1.0, 0.05, -0.1));
  const Vec3 k = glm::normalize(glm::cross(i, Vec3(0.02, 1.0, 0.1)));
  g.direction = Mat3(i, glm::cross(k, i), k);
  ct.hu.resize(g.voxelCount());
  LabelMap map{g, std::vector<std::uint8_t>(g.voxelCount())};
  map.structures = {{1, "liver", Vec3(0.8, 0.4, 0.3)},
                    {2, "\xE8\xA1\x80\xE7\xAE\xA1 vessel", Vec3(0.1, 0.2, 1.0)},
                    {7, "left kidney", Vec3(1.0, 1.0, 0.0)},
                    {9, "nowhere", Vec3(0.5)}};
  for (std::size_t n = 0; n < ct.hu.size(); ++n) {
    const Index3 at = g.indicesOf(n);
    ct.hu[n] = std::int16_t(int(n * 7 % 3001) - 1000);
    const Vec3 p = Vec3(at[0], at[1], at[2]) - Vec3(16.0, 13.0, 8.0);
    const double liver = glm::length(p / Vec3(12.0, 9.0, 6.0));
    const double vessel = glm::length(Vec3(p.x - 0.5 * p.z, p.y + 0.2 * p.z, 0.0));
    if (liver < 1.0) map.labels[n] = 1;
    if (vessel < 2.0 && liver < 1.4) map.labels[n] = 2;
    if (at[0] > 32 && at[1] % 3 == 0 && at[2] % 4 == 1) map.labels[n] = 7;  // gaps between slices
  }
  const auto written = writeStructuresAsDicom(ct, map, folder);
  if (!written) return errorJson(written.error());
  if (!save(labels_file, map.labels, false)) return {{"error", "CANNOT_WRITE"}};
  Json json = gridJson(g);
  json["notes"] = written->notes;
  for (const Structure& s : map.structures) {
    json["structures"].push_back(
        {{"label", s.label}, {"name", s.name}, {"colour", vectorJson(s.colour)}});
  }
  return json;
}

Json read(const std::string& file, double threshold, const std::string& layers_file) {
  const auto read = readDicomSegmentation(file, threshold);
  if (!read) return errorJson(read.error());
  const Segmentation& s = read->segmentation;
  Json json = gridJson(s.geometry);
  json["notes"] = s.notes;
  json["layers"] = s.layers.size();
  json["is_segmentation"] = isDicomSegmentation(file);
  for (const Segmentation::Segment& one : s.segments) {
    json["segments"].push_back({{"name", one.name},
                                {"colour", vectorJson(one.colour)},
                                {"layer", one.layer},
                                {"value", one.value}});
  }
  for (std::size_t n = 0; n < s.layers.size(); ++n) {
    if (!save(layers_file, s.layers[n], n > 0)) return {{"error", "CANNOT_WRITE"}};
  }
  return json;
}

}  // namespace

}  // namespace trephine

int main(int count, char** arguments) {
  const std::string what = count > 1 ? arguments[1] : "";
  trephine::Json json;
  if (what == "write" && count == 4) {
    json = trephine::write(arguments[2], arguments[3]);
  } else if (what == "read" && count == 5) {
    json = trephine::read(arguments[2], std::stod(arguments[3]), arguments[4]);
  } else {
    std::cerr << "usage: dicom_seg write FOLDER LABELS | dicom_seg read FILE THRESHOLD LAYERS\n";
    return 2;
  }
  std::cout << json.dump() << "\n";
  return 0;
}
