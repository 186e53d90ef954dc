#include "render/tool_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>

namespace trephine {

namespace {

constexpr std::size_t kHeader_bytes = 84;
constexpr std::size_t kTriangle_bytes = 50;
const char* const kExportAgain = "Export it again as STL, in millimetres";

// More faces than this around one corner come from a damaged file; they are shaded flat, or their
// comparison with each other would take minutes.
constexpr std::ptrdiff_t kMostFacesAround = 256;

Error meshError(const char* code, std::string what, const std::filesystem::path& file,
                std::string next = kExportAgain) {
  return Error{code, std::move(what), file.string(), std::move(next)};
}

std::uint32_t littleEndian(const char* bytes) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | std::uint8_t(bytes[i]);
  return value;
}

std::optional<ToolMesh> parseBinary(std::string_view bytes) {
  const std::size_t count = littleEndian(bytes.data() + kHeader_bytes - 4);
  if (bytes.size() != kHeader_bytes + kTriangle_bytes * count) return std::nullopt;
  ToolMesh mesh;
  mesh.corners.reserve(3 * count);
  for (std::size_t t = 0; t < count; ++t) {
    // The normal in front is left alone: many exporters write zeros there.
    const char* at = bytes.data() + kHeader_bytes + kTriangle_bytes * t + 12;
    for (int corner = 0; corner < 3; ++corner, at += 12) {
      glm::vec3 p;
      for (int i = 0; i < 3; ++i) p[i] = std::bit_cast<float>(littleEndian(at + 4 * i));
      mesh.corners.push_back(p);
    }
  }
  return mesh;
}

// The words of an ASCII STL.
class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {}

  std::string_view next() {
    const std::size_t from = rest_.find_first_not_of(" \t\r\n\v\f");
    if (from == std::string_view::npos) return rest_ = {};
    rest_.remove_prefix(from);
    const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r\n\v\f"));
    rest_.remove_prefix(word.size());
    return word;
  }
  void skipLine() { rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size())); }
  bool atEnd() const { return rest_.find_first_not_of(" \t\r\n\v\f") == std::string_view::npos; }

 private:
  std::string_view rest_;
};

bool same(std::string_view word, std::string_view lower_case) {
  return std::equal(word.begin(), word.end(), lower_case.begin(), lower_case.end(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; });
}

// NaN for what is not finite in a double, nothing for what is no number.
std::optional<float> numberOf(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || end != word.data() + word.size()) return std::nullopt;
  if (problem != std::errc{} || !isFinite(value)) return std::nanf("");
  return float(std::clamp(value, -1e30, 1e30));  // no float beyond 3e38; both are too far off
}

enum class AsciiEnd { whole, early, other };

// Solids one after another, as some programs write one for each part.
AsciiEnd parseAscii(std::string_view text, ToolMesh& mesh) {
  Words words(text);
  const auto unexpected = [&] { return words.atEnd() ? AsciiEnd::early : AsciiEnd::other; };
  while (!words.atEnd()) {
    if (!same(words.next(), "solid")) return AsciiEnd::other;
    words.skipLine();
    std::string_view word;
    while (same(word = words.next(), "facet")) {
      if (!same(words.next(), "normal")) return unexpected();
      for (int i = 0; i < 3; ++i) words.next();
      if (!same(words.next(), "outer") || !same(words.next(), "loop")) return unexpected();
      glm::vec3 corners[3];
      for (glm::vec3& corner : corners) {
        if (!same(words.next(), "vertex")) return unexpected();
        for (int i = 0; i < 3; ++i) {
          const std::optional<float> value = numberOf(words.next());
          if (!value) return unexpected();
          corner[i] = *value;
        }
      }
      if (!same(words.next(), "endloop") || !same(words.next(), "endfacet")) return unexpected();
      mesh.corners.insert(mesh.corners.end(), corners, corners + 3);
    }
    if (!same(word, "endsolid")) return unexpected();
    words.skipLine();
  }
  return AsciiEnd::whole;
}

Result<std::string> readBytes(const std::filesystem::path& file) {
  std::error_code ec;
  if (!std::filesystem::is_regular_file(file, ec)) {
    return meshError("MISSING_FILE", "There is no such mesh", file,
                     "Put it beside the tool's data file");
  }
  const std::uintmax_t size = std::filesystem::file_size(file, ec);
  if (!ec && size > kLargestToolMesh_bytes) {
    return meshError("MESH_TOO_LARGE",
                     "The mesh has " + std::to_string(size >> 20) + " MiB, more than 64", file,
                     "Reduce its triangles");
  }
  std::string bytes(ec ? 0 : size, '\0');
  std::ifstream stream(file, std::ios::binary);
  if (ec || !stream.read(bytes.data(), std::streamsize(size))) {
    return meshError("CANNOT_READ", "The mesh could not be read", file,
                     "Check that you may read it");
  }
  return bytes;
}

Result<ToolMesh> parse(std::string_view bytes, const std::filesystem::path& file) {
  if (bytes.empty()) return meshError("MESH_EMPTY", "The mesh is an empty file", file);
  // Binary files may begin with the word "solid" too: the length decides.
  if (bytes.size() >= kHeader_bytes) {
    if (std::optional<ToolMesh> mesh = parseBinary(bytes)) return *std::move(mesh);
  }
  const Error truncated = meshError("MESH_TRUNCATED", "The mesh ends too early", file);
  const std::string_view first = Words(bytes).next();
  if (same(first, "solid") && bytes.find('\0') == std::string_view::npos) {
    ToolMesh mesh;
    const AsciiEnd end = parseAscii(bytes, mesh);
    if (end == AsciiEnd::whole) return mesh;
    if (end == AsciiEnd::early) return truncated;
  } else if (bytes.size() >= kHeader_bytes) {
    const std::uint64_t count = littleEndian(bytes.data() + kHeader_bytes - 4);
    const std::uint64_t whole = kHeader_bytes + kTriangle_bytes * count;
    // A length beyond all limits is no length: these bytes mean something else.
    if (whole > bytes.size() && whole <= kLargestToolMesh_bytes) return truncated;
  }
  return meshError("NOT_STL", "The mesh is not an STL file", file);
}

glm::dvec3 faceCross(const ToolMesh& mesh, std::size_t triangle) {
  const glm::dvec3 a = mesh.corners[3 * triangle];
  return glm::cross(glm::dvec3(mesh.corners[3 * triangle + 1]) - a,
                    glm::dvec3(mesh.corners[3 * triangle + 2]) - a);
}

// A face may lose its area when it is moved far in floats; any direction is right for it.
glm::dvec3 direction(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0.0 ? v / length : glm::dvec3(0, 0, 1);
}

}  // namespace

Result<ToolMesh> readToolMesh(const std::filesystem::path& file) {
  Result<std::string> bytes = readBytes(file);
  if (!bytes) return bytes.error();
  Result<ToolMesh> parsed = parse(*bytes, file);
  if (!parsed) return parsed;
  ToolMesh mesh;
  for (std::size_t t = 0; t < parsed->corners.size() / 3; ++t) {
    for (std::size_t i = 3 * t; i < 3 * t + 3; ++i) {
      const glm::vec3& p = parsed->corners[i];
      const float most = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
      const std::string where = " of triangle " + std::to_string(t + 1);
      if (!isFinite(Vec3(p))) {
        return meshError("MESH_NOT_FINITE", "A corner" + where + " is not finite", file);
      }
      if (most > kFarthestToolMesh_mm) {
        return meshError("MESH_TOO_FAR", "A corner" + where + " lies more than 10 m off", file);
      }
    }
    if (glm::length(faceCross(*parsed, t)) == 0.0) continue;
    mesh.corners.insert(mesh.corners.end(), parsed->corners.begin() + std::ptrdiff_t(3 * t),
                        parsed->corners.begin() + std::ptrdiff_t(3 * t + 3));
  }
  if (mesh.corners.empty()) return meshError("MESH_EMPTY", "The mesh has no triangles", file);
  return mesh;
}

Status checkToolMesh(const std::filesystem::path& file) {
  const Result<ToolMesh> mesh = readToolMesh(file);
  return mesh ? Status{} : Status{mesh.error()};
}

Result<ToolMesh> inToolFrame(const ToolMesh& mesh, const Vec3& tip_mm, const Vec3& axis) {
  const double length = glm::length(axis);
  const bool near = isFinite(tip_mm) && std::abs(tip_mm.x) <= kFarthestToolMesh_mm &&
                    std::abs(tip_mm.y) <= kFarthestToolMesh_mm &&
                    std::abs(tip_mm.z) <= kFarthestToolMesh_mm;
  if (!near || !isFinite(length) || length < 1e-6) {
    return Error{"BAD_TOOL_FRAME",
                 near ? "The axis has no direction" : "The tip does not lie within 10 m",
                 near ? "axis" : "tip_mm", "Correct it in the tool's data file"};
  }
  const Vec3 a = axis / length, z(0, 0, 1);
  const Quat turn =
      a.z < -1.0 + 1e-12 ? Quat(0, 0, 1, 0) : glm::normalize(Quat(1.0 + a.z, glm::cross(a, z)));
  const Mat3 to_tool = glm::mat3_cast(turn);
  ToolMesh moved;
  moved.corners.reserve(mesh.corners.size());
  for (const glm::vec3& p : mesh.corners) moved.corners.push_back(to_tool * (Vec3(p) - tip_mm));
  return moved;
}

std::vector<glm::vec3> cornerNormals(const ToolMesh& mesh, double feature_angle_deg) {
  const std::vector<glm::vec3>& corners = mesh.corners;
  std::vector<std::size_t> order(corners.size());  // corners at one place, side by side
  std::iota(order.begin(), order.end(), std::size_t(0));
  const auto key = [&](std::size_t i) {
    return std::array{corners[i].x, corners[i].y, corners[i].z};
  };
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return key(a) < key(b); });

  // Weighted by the corner's angle, so that it does not matter how a face is cut into triangles.
  const auto angleAt = [&](std::size_t i) {
    const std::size_t first = i - i % 3;
    const glm::dvec3 p = corners[i];
    const glm::dvec3 u = direction(glm::dvec3(corners[first + (i + 1) % 3]) - p);
    const glm::dvec3 v = direction(glm::dvec3(corners[first + (i + 2) % 3]) - p);
    return std::acos(std::clamp(glm::dot(u, v), -1.0, 1.0));
  };
  std::vector<glm::dvec3> faces(corners.size() / 3);
  for (std::size_t t = 0; t < faces.size(); ++t) faces[t] = direction(faceCross(mesh, t));

  const double least_cosine = std::cos(glm::radians(feature_angle_deg));
  std::vector<glm::vec3> normals(corners.size());
  for (auto from = order.begin(); from != order.end();) {
    const auto to = std::find_if(from, order.end(),
                                 [&](std::size_t i) { return corners[i] != corners[*from]; });
    for (auto one = from; one != to; ++one) {
      const glm::dvec3 own = faces[*one / 3];
      glm::dvec3 sum = own * 1e-9;
      if (to - from <= kMostFacesAround) {
        for (auto other = from; other != to; ++other) {
          const glm::dvec3 face = faces[*other / 3];
          if (glm::dot(face, own) >= least_cosine) sum += face * angleAt(*other);
        }
      }
      normals[*one] = direction(sum);
    }
    from = to;
  }
  return normals;
}

}  // namespace trephine
