#include "lab/import/import_loaders.h"

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

#include "base/child_process.h"
#include "base/json.h"

namespace trephine {

namespace {

// The answer of a command of ours, or what it or the system says is wrong.
struct OwnRun {
  ChildRun child;
  Json answer;
  std::string problem;
};

Result<OwnRun> runOurs(const OwnProgram& program, const LoaderTask& task,
                       std::vector<std::string> words) {
  ChildCommand command;
  command.words = std::move(words);
  command.output = task.empty / "answer.json";
  command.home = task.empty;
  command.limit_s = program.limit_s;
  command.measures_memory = true;
  Result<ChildRun> child = runChild(command, task.progress);
  if (!child) return child.error();
  OwnRun run{*child, {}, {}};
  if (child->timed_out) {
    run.problem = tookTooLong(program.limit_s);
    return run;
  }
  Result<Json> answer = readJsonFile(command.output);
  if (!answer) {
    run.problem = "gave no answer (exit code " + std::to_string(child->exit_code) + ")";
    return run;
  }
  run.answer = *std::move(answer);
  if (run.answer.contains("error")) run.problem = run.answer["error"].value("what", "failed");
  return run;
}

// The report of `trephine-lab import` of a folder.
Result<OwnRun> runImport(const OwnProgram& program, const LoaderTask& task) {
  return runOurs(program, task, {program.file.string(), "import", task.folder.string(), "--json"});
}

// A number of the report, 0 where it has none.
double number(const Json& report, const std::string& pointer) {
  const Json::json_pointer at(pointer);
  return report.contains(at) && report[at].is_number() ? report[at].get<double>() : 0.0;
}

bool reportsVolume(const Json& report, const std::string& sha256) {
  if (!report.contains("series") || !report.contains("chosen")) return false;
  return std::any_of(report["series"].begin(), report["series"].end(), [&](const Json& series) {
    return series.is_object() && series.contains("uid") && series["uid"] == report["chosen"] &&
           series.contains("volume_sha256") && series["volume_sha256"] == sha256;
  });
}

Loader importLoader(const OwnProgram& program) {
  Loader loader;
  loader.names = {"trephine", "trephine command"};
  loader.threads = int(std::max(1U, std::thread::hardware_concurrency()));
  loader.run = [program](const LoaderTask& task) -> Result<LoaderRun> {
    Result<OwnRun> ours = runImport(program, task);
    if (!ours) return ours.error();
    LoaderRun run;
    run.problem = ours->problem;
    if (!run.problem.empty()) {
      run.correct = false;
      return run;
    }
    const Json& report = ours->answer;
    if (task.known) run.correct = reportsVolume(report, task.known->sha256);
    ImportSample sample;
    sample.peak_rss_mb = ours->child.peak_rss_mb.value_or(0.0);
    sample.above_start_mb = number(report, "/peak_rss_mb") - number(report, "/start_rss_mb");
    sample.seconds = number(report, "/seconds/scan") + number(report, "/seconds/read");
    run.samples.push_back(sample);
    sample.seconds = ours->child.seconds - number(report, "/seconds/hash");
    run.samples.push_back(sample);
    return run;
  };
  return loader;
}

Loader floorLoader(const OwnProgram& program) {
  Loader loader;
  loader.names = {"floor", "floor kept"};
  loader.run = [program](const LoaderTask& task) -> Result<LoaderRun> {
    Result<OwnRun> ours =
        runOurs(program, task, {program.measure.string(), "read", task.folder.string(), "--json"});
    if (!ours) return ours.error();
    if (!ours->problem.empty()) return failedRun(ours->problem);
    LoaderRun run;
    for (const char* figure : {"/seconds", "/kept_seconds"}) {
      run.samples.push_back({number(ours->answer, figure), ours->child.peak_rss_mb.value_or(0.0), {}});
    }
    return run;
  };
  return loader;
}

}  // namespace

std::string tookTooLong(double limit_s) {
  return "took over " + std::to_string(std::lround(limit_s)) + " s";
}

LoaderRun failedRun(std::string why) {
  LoaderRun run;
  run.problem = std::move(why);
  return run;
}

std::vector<Loader> ownLoaders(const OwnProgram& program) {
  return {importLoader(program), floorLoader(program)};
}

Loader ownScanner(const OwnProgram& program) {
  Loader loader;
  loader.names = {"trephine"};
  loader.threads = int(std::max(1U, std::thread::hardware_concurrency()));
  loader.run = [program](const LoaderTask& task) -> Result<LoaderRun> {
    Result<OwnRun> ours = runImport(program, task);
    if (!ours) return ours.error();
    if (!ours->problem.empty()) return failedRun(ours->problem);
    LoaderRun run;
    run.samples.push_back({number(ours->answer, "/seconds/scan"), ours->child.peak_rss_mb.value_or(0.0), {}});
    return run;
  };
  return loader;
}

}  // namespace trephine
