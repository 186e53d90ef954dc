// A commissioning as JSON, as lines and as a page.
#include <cmath>
#include <cstdio>

#include "base/html.h"
#include "base/purpose.h"
#include "lab/commission/commission.h"
#include "lab/common/spread.h"

namespace trephine {

namespace {

std::string shown(const std::optional<double>& value, const std::string& unit) {
  if (!value) return "not measured";
  char text[64];
  const double size = std::abs(*value);
  std::snprintf(text, sizeof text,
                size >= 100.0  ? "%.0f %s"
                : size >= 10.0 ? "%.1f %s"
                               : "%.2f %s",
                *value, unit.c_str());
  if (unit == "granted" || unit == "installed") return *value > 0.0 ? "yes" : "no";
  if (unit == "drawn by") return *value > 0.0 ? "a graphics card" : "the processors";
  if (unit == "MB" && *value >= 1e6) return "without limit";
  if (unit == "arms") std::snprintf(text, sizeof text, "%.0f", *value);
  if (unit == "lines") std::snprintf(text, sizeof text, "%.0f lines", *value);
  if (unit == "of 1") std::snprintf(text, sizeof text, "%.2f", *value);
  return text;
}

const char* inWords(Fitness verdict) {
  return verdict == Fitness::pass   ? "This workstation is fit for exercises."
         : verdict == Fitness::warn ? "This workstation can be used; what could be better is below."
                                    : "This workstation is not fit for exercises yet.";
}

std::optional<Fitness> fitnessNamed(const std::string& name) {
  for (const Fitness each : {Fitness::pass, Fitness::warn, Fitness::fail}) {
    if (name == nameOf(each)) return each;
  }
  return {};
}

// Those that are passed, or those that are not, the worst first.
std::string tableOf(const Commissioning& of, const char* title, bool passed) {
  std::string rows;
  for (const Fitness each : {Fitness::fail, Fitness::warn, Fitness::pass}) {
    for (const CommissionCheck& check : of.checks) {
      if (check.verdict != each || passed != (each == Fitness::pass)) continue;
      const CommissionLimit* by = commissionLimit(check.name);
      rows += "<tr><td class=\"" + std::string(nameOf(check.verdict)) + "\">" +
              nameOf(check.verdict) + "</td><td>" + inHtml(check.words) + "<br><small>" +
              (by ? inHtml(by->reason) : "") + "</small></td><td>" +
              inHtml(shown(check.value, check.unit));
      if (!check.remark.empty()) rows += "<br><small>" + inHtml(check.remark) + "</small>";
      rows += "</td><td>";
      if (check.limit) {
        rows += (by && by->at_least ? "at least " : "at most ") +
                inHtml(shown(check.limit, check.unit));
      }
      rows += passed ? "</td></tr>\n" : "</td><td>" + inHtml(check.next) + "</td></tr>\n";
    }
  }
  if (rows.empty()) return rows;
  return std::string("<h2>") + title +
         "</h2>\n<table width=\"100%\">\n<tr><th width=\"9%\"></th><th>What</th><th>Here</th>"
         "<th width=\"16%\">Limit</th>" +
         (passed ? "" : "<th width=\"30%\">Next step</th>") + "</tr>\n" + rows + "</table>\n";
}

}  // namespace

std::string changeText(const CommissionChange& change) {
  return change.words + ": " + shown(change.value_before, change.unit) + " (" +
         nameOf(change.before) + ") before, " + shown(change.value_now, change.unit) + " (" +
         nameOf(change.now) + ") now";
}

Json toJson(const Commissioning& of) {
  Json checks = Json::array();
  for (const CommissionCheck& check : of.checks) {
    checks.push_back({{"name", check.name},
                      {"value", orNull(check.value)},
                      {"unit", check.unit},
                      {"limit", orNull(check.limit)},
                      {"verdict", nameOf(check.verdict)},
                      {"next", check.next},
                      {"words", check.words},
                      {"remark", check.remark}});
  }
  return {{"checks", checks},
          {"verdict", nameOf(fitnessOf(of))},
          {"when", of.when},
          {"build", of.build},
          {"machine", of.machine}};
}

Result<Commissioning> readCommissioning(const std::filesystem::path& file) {
  const Result<Json> json = readJsonFile(file);
  if (!json) return json.error();
  const auto bad = [&](const char* field) {
    return Error{"BAD_FIELD", "This is no commissioning of ours", file.string() + ": " + field,
                 "Commission the workstation anew"};
  };
  try {
    Commissioning of{{}, json->at("when"), json->at("build"), json->at("machine"), {}};
    for (const Json& row : json->at("checks")) {
      const auto verdict = fitnessNamed(row.at("verdict").get<std::string>());
      if (!verdict) return bad("verdict");
      CommissionCheck check{row.at("name"), row.at("words"), {}, row.at("unit"), {}, *verdict,
                            row.at("next"), row.at("remark")};
      if (!row.at("value").is_null()) check.value = row.at("value").get<double>();
      if (!row.at("limit").is_null()) check.limit = row.at("limit").get<double>();
      of.checks.push_back(std::move(check));
    }
    return of;
  } catch (const Json::exception&) {
    return bad("checks");
  }
}

std::string toText(const Commissioning& of, const std::vector<CommissionChange>& changes) {
  std::string text;
  for (const CommissionCheck& check : of.checks) {
    char line[256];
    std::snprintf(line, sizeof line, "%-4s  %-62s  %s\n", nameOf(check.verdict),
                  check.words.c_str(), shown(check.value, check.unit).c_str());
    text += line;
    if (check.verdict != Fitness::pass && !check.next.empty()) text += "      " + check.next + "\n";
  }
  for (const CommissionChange& change : changes)
    text += "since last time: " + changeText(change) + "\n";
  return text + inWords(fitnessOf(of)) + "\n";
}

std::string toHtml(const Commissioning& of, const std::vector<CommissionChange>& changes) {
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<title>Commissioning of a Trephine workstation</title>\n<style>\n"
      "body{font:11pt sans-serif;margin:2em;color:#222}table{border-collapse:collapse;width:100%}\n"
      "td,th{text-align:left;padding:.3em .6em;border-bottom:1px solid #bbb;vertical-align:top}\n"
      ".pass{color:#166534}.warn{color:#92400e;font-weight:bold}.fail{color:#991b1b;font-weight:"
      "bold}\n"
      "small{color:#555}@media print{body{margin:0}}\n</style></head><body>\n"
      "<h1>Commissioning of this workstation</h1>\n";
  page += "<p class=\"" + std::string(nameOf(fitnessOf(of))) + "\">" + inWords(fitnessOf(of)) +
          "</p>\n";
  page += "<p>" + inHtml(of.when) + " &middot; Trephine " + inHtml(of.build) + " &middot; " +
          inHtml(of.machine) + "</p>\n";
  page += tableOf(of, "What could be better", false) + tableOf(of, "What is well", true);
  page += "<h2>Since the last commissioning</h2>\n";
  if (changes.empty()) page += "<p>Nothing is otherwise, or there was none before.</p>\n";
  for (const CommissionChange& change : changes)
    page += "<p>" + inHtml(changeText(change)) + "</p>\n";
  return page + "<p><small>" + kPurpose + ".</small></p>\n</body></html>\n";
}

}  // namespace trephine
