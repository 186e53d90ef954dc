#include <algorithm>
#include <cstdio>

#include "app/answer.h"
#include "app/lab_commands.h"
#include "base/codes.h"
#include "base/file.h"
#include "base/log.h"
#include "imaging/codes.h"
#include "imaging/importer.h"
#include "imaging/report/provenance.h"
#include "imaging/report/report_page.h"
#include "volume/codes.h"
#include "volume/volume_files.h"

namespace trephine {

namespace {

// "At: 12.00 mm, 13.00 mm and 4 more. "
std::string placesOf(const Finding& finding) {
  constexpr std::size_t kMost = 6;
  std::string text;
  for (std::size_t n = 0; n < std::min(finding.slices.size(), kMost); ++n) {
    text += (n == 0 ? "At: " : ", ") + finding.slices[n];
  }
  if (finding.slices.size() > kMost) {
    text += " and " + std::to_string(finding.slices.size() - kMost) + " more";
  }
  return text.empty() ? text : text + ". ";
}

// What a series is called may say whom it shows.
void printReport(const ImportReport& report, Identity identity) {
  for (const SeriesReport& s : report.series) {
    const GridGeometry& g = s.geometry;
    say("%-8s  ", verdictName(s.verdict));
    if (s.verdict != Verdict::refused || g.spacing_mm.z > 0.0) {
      say("%dx%dx%d  %.3f x %.3f x %.3f mm  ", g.size[0], g.size[1], g.size[2], g.spacing_mm.x,
          g.spacing_mm.y, g.spacing_mm.z);
    }
    say("%s  %s\n", s.modality.c_str(), identity == Identity::shown ? s.description.c_str() : "");
    if (report.series.size() > 1) {
      const char* mark = "";
      if (report.chosen && s.verdict != Verdict::refused) mark = "  (not read)";
      if (report.chosen == s.uid) mark = "  (this one was read)";
      say("          --series %zu%s\n", std::size_t(&s - report.series.data()) + 1, mark);
    }
    for (const Finding& f : s.findings) {
      say("          %s: %s. %s%s\n", f.code.c_str(), f.text.c_str(), placesOf(f).c_str(),
          f.action.c_str());
    }
    for (const Choice& c : s.choices) {
      say("          %s\n", c.question.c_str());
      for (std::size_t n = 0; n < c.options.size(); ++n) {
        const std::string more =
            n < c.on_screen.size() && !c.on_screen[n].empty() ? " (" + c.on_screen[n] + ")" : "";
        say("            --choice %s=%s  %s%s\n", c.code.c_str(), c.options[n].c_str(),
            c.words[n].c_str(), more.c_str());
      }
    }
  }
  for (const SkippedFiles& s : report.skipped) {
    say("skipped   %d: %s\n", s.count, s.reason.c_str());
  }
}

// Three ranges "A:B", each of voxels A to B - 1.
std::optional<VoxelBox> parseBox(const std::string& text) {
  VoxelBox box;
  int end = 0;
  const int read = std::sscanf(text.c_str(), "%d:%d,%d:%d,%d:%d%n", &box.low[0], &box.high[0],
                               &box.low[1], &box.high[1], &box.low[2], &box.high[2], &end);
  if (read != 6 || std::size_t(end) != text.size()) return std::nullopt;
  return box;
}

Result<ImportRequest> importRequest(const ImportArguments& arguments) {
  ImportRequest request;
  for (const std::string& choice : arguments.choices) {
    const std::size_t equals = choice.find('=');
    if (equals == std::string::npos) {
      return Error{code::kBadArgument, "A choice is written CODE=OPTION, not '" + choice + "'",
                   "--choice", "The report lists codes and options"};
    }
    const auto [known, added] = request.answers.try_emplace(Code::named(choice.substr(0, equals)),
                                                            choice.substr(equals + 1));
    if (!added && known->second != choice.substr(equals + 1)) {
      return Error{code::kBadArgument, known->first.str() + " is answered twice, and not alike",
                   "--choice", "Answer each question once"};
    }
  }
  if (arguments.phase) request.answers[code::kPhases] = std::to_string(*arguments.phase);
  if (!arguments.crop.empty()) {
    request.crop = parseBox(arguments.crop);
    if (!request.crop) {
      return Error{code::kBadArgument, "'" + arguments.crop + "' is no box of voxels", "--crop",
                   "Write I0:I1,J0:J1,K0:K1"};
    }
  }
  if (arguments.half) request.reduction = 2;
  if (arguments.quarter) request.reduction = 4;
  return request;
}

// A face that nobody was asked about must not leave the computer unnoticed.
void warnOfFace(const Provenance& provenance) {
  if (std::ranges::find(provenance.unanswered, code::kFace) == provenance.unanswered.end()) return;
  spdlog::warn(
      "The patient's face can be reconstructed from the volume that was written: before it "
      "leaves this computer, write it again with --choice FACE=deface");
}

// What is written can be written, as far as that can be said before a long run. Nothing is written
// over, least of all the scan that is read.
Status checkTargets(const ImportArguments& arguments) {
  if (!arguments.write.empty()) {
    if (Status can = checkVolumeFileName(arguments.write); !can) return can;
  }
  if (!arguments.report.empty() && !std::string_view(arguments.report).ends_with(".html")) {
    return Error{code::kUnknownFormat, "A report is written as .html", arguments.report,
                 "Give the file this ending; the window also saves PDF"};
  }
  for (const auto& [target, option] :
       {std::pair(arguments.write, "--write"), std::pair(arguments.report, "--report")}) {
    if (target.empty()) continue;
    if (Status free = checkNewFile(target, option); !free) return free;
  }
  return {};
}

}  // namespace

int importCommand(const ImportArguments& arguments, bool json, const Progress& progress) {
  const Identity identity = arguments.with_identity ? Identity::shown : Identity::hidden;
  const auto fail = [&](Error error, const ImportReport* report) {
    ImportReport nothing;
    nothing.path = arguments.path;
    Json extra = toJson(report ? *report : nothing, identity);
    extra["chosen"] = nullptr;
    if (json && identity == Identity::hidden) error.where.clear();
    if (!json && report) printReport(*report, identity);
    printError("import", error, json, extra);
    return 2;
  };
  Result<ImportRequest> request = importRequest(arguments);
  if (!request) return fail(request.error(), nullptr);
  if (Status can = checkTargets(arguments); !can) return fail(can.error(), nullptr);
  Result<CtFolder> folder = CtFolder::scan(arguments.path, progress);
  if (!folder) return fail(folder.error(), nullptr);
  const auto saveReport = [&]() -> Status {
    if (arguments.report.empty()) return {};
    return writeTextFile(arguments.report, reportPage(folder->report()));
  };
  if (Status fit = folder->checkAnswers(request->answers); !fit) {
    return fail(fit.error(), &folder->report());
  }
  const std::optional<std::string> uid = arguments.series.empty()
                                             ? folder->bestSeries(request->answers)
                                             : std::optional<std::string>(arguments.series);
  if (!uid) {
    if (Status saved = saveReport(); !saved) return fail(saved.error(), &folder->report());
    const Error none{code::kAllRefused, "No series in the folder can be used", arguments.path,
                     "The findings say why for each"};
    return fail(folder->report().error.value_or(none), &folder->report());
  }
  Result<Volume> volume = folder->read(*uid, *request, progress);
  if (Status saved = saveReport(); !saved) return fail(saved.error(), &folder->report());
  if (!volume) return fail(volume.error(), &folder->report());
  const std::vector<Code> unused = folder->report().provenance->unused_answers;
  for (const Code& code : unused) {
    spdlog::warn("The series did not ask {}: that answer changed nothing", code.str());
  }
  if (!arguments.write.empty()) {
    Status written = writeVolume(slabsOf(*volume), arguments.write, progress);
    if (written) written = writeProvenance(*folder->report().provenance, arguments.write);
    if (!written) return fail(written.error(), &folder->report());
    warnOfFace(*folder->report().provenance);
  }
  if (json) {
    printAnswer("import", toJson(folder->report(), identity));
  } else {
    printReport(folder->report(), identity);
  }
  return unused.empty() ? 0 : 3;
}

}  // namespace trephine
