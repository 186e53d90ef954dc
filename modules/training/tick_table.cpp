#include "training/tick_table.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <limits>
#include <locale>
#include <string_view>

#include "base/codes.h"
#include "base/file.h"
#include "base/tr.h"

namespace trephine {

namespace {

constexpr std::uint64_t kSlice = 4096;  // ticks

// As a field of its own, whatever an exercise calls an arm.
std::string quoted(std::string text) {
  // A spreadsheet would take it for a formula.
  if (!text.empty() && std::string_view("=+-@\t\r").find(text.front()) != std::string_view::npos) {
    text.insert(0, 1, '\'');
  }
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string out = "\"";
  for (char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

Status writeTo(const SessionReader& recording, std::ofstream& out, const Progress& progress) {
  const Json& exercise = recording.header().exercise;
  const double rate_hz = exercise.at("rate_hz").get<double>();
  out.imbue(std::locale::classic());
  out << std::setprecision(std::numeric_limits<double>::max_digits10);
  out << "tick,t_s,arm,x_m,y_m,z_m,v_x_m_s,v_y_m_s,v_z_m_s,f_e_x_N,f_e_y_N,f_e_z_N,E_obs_J,"
         "alpha,f_c_x_N,f_c_y_N,f_c_z_N,sent_x_N,sent_y_N,sent_z_N,proxy_x_mm,proxy_y_mm,"
         "proxy_z_mm,tool_state,controller_parts\n";
  std::array<std::string, kMaxArms> names;
  for (std::size_t i = 0; i < recording.armCount(); ++i) {
    names[i] = quoted(exercise.at("arms").at(i).at("name").get<std::string>());
  }
  const auto add = [&](const Vec3& v) { out << ',' << v.x << ',' << v.y << ',' << v.z; };
  const std::uint64_t count = recording.tickCount();
  std::array<Vec3, kMaxArms> before_m;
  for (std::uint64_t first = 0; first < count && out; first += kSlice) {
    if (progress.cancelled()) return Error{code::kCancelled, tr("The table was cancelled"), "", ""};
    progress.at(double(first) / double(count), tr("Writing the table"));
    auto ticks = recording.ticks(first, std::min(kSlice, count - first));
    if (!ticks) return ticks.error();
    for (const TickRecord& tick : *ticks) {
      for (std::size_t i = 0; i < recording.armCount(); ++i) {
        const ArmRecord& arm = tick.arms[i];
        out << tick.tick << ',' << double(tick.tick) / rate_hz << ',' << names[i];
        const bool first_tick = first == 0 && &tick == ticks->data();
        add(arm.device_position_m);
        add(first_tick ? Vec3(0.0) : (arm.device_position_m - before_m[i]) / (1.0 / rate_hz));
        before_m[i] = arm.device_position_m;
        add(arm.demanded_N);
        // Of the controller in force: `bounded` alone has a learnt scale, which is above 0.
        const bool bounded = arm.learnt_scale > 0.0;
        out << ',' << (bounded ? arm.credit_J : arm.observer_J) << ','
            << (bounded ? arm.learnt_scale : arm.alpha);
        add(arm.bounded_N);
        add(arm.sent_N);
        add(arm.proxy_position_mm);
        out << ',' << arm.tool_state << ',' << arm.controller_parts << '\n';
      }
    }
  }
  return {};
}

}  // namespace

Status writeTickTable(const SessionReader& recording, const std::filesystem::path& file,
                      const Progress& progress) {
  return replaceFile(file, [&](const std::filesystem::path& temporary) -> Status {
    errno = 0;
    std::ofstream out(temporary, std::ios::binary);
    Status written = writeTo(recording, out, progress);
    if (out) out.close();
    if (!written || out) return written;
    const int error = errno;
    return Error{code::kCannotWrite,
                 tr("The table could not be written: {}",
                    error ? std::strerror(error) : tr("unknown reason")),
                 file.string(), afterFailedWrite(error)};
  });
}

}  // namespace trephine
