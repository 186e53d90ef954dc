// A commissioning as JSON, as lines and as a page.
#include <cmath>
#include <cstdio>

#include "base/codes.h"
#include "base/html.h"
#include "base/purpose.h"
#include "base/tr.h"
#include "machine/commission/commission.h"
#include "machine/common/spread.h"

namespace trephine {

std::string shownValue(const std::optional<double>& value, const std::string& unit) {
  if (!value) return tr("not measured");
  char text[64];
  const double size = std::abs(*value);
  std::snprintf(text, sizeof text,
                size >= 100.0  ? "%.0f %s"
                : size >= 10.0 ? "%.1f %s"
                               : "%.2f %s",
                *value, unit.c_str());
  if (unit == "us") std::snprintf(text, sizeof text, "%.0f \u00b5s", *value);
  if (unit == "granted" || unit == "installed") return *value > 0.0 ? tr("yes") : tr("no");
  if (unit == "drawn by") return *value > 0.0 ? tr("a graphics card") : tr("the processors");
  if (unit == "MB" && *value >= 1e6) return tr("without limit");
  if (unit == "arms") std::snprintf(text, sizeof text, "%.0f", *value);
  if (unit == "lines") std::snprintf(text, sizeof text, "%.0f lines", *value);
  if (unit == "of 1") std::snprintf(text, sizeof text, "%.2f", *value);
  return text;
}

namespace {

constexpr const char* kFormat = "trephine.commission";
constexpr int kVersion = 1;

std::string inWords(Fitness verdict) {
  return verdict == Fitness::pass ? tr("This workstation is fit for exercises.")
         : verdict == Fitness::warn
             ? tr("This workstation can be used; some of it could be better.")
             : tr("This workstation is not fit for exercises yet.");
}

std::optional<Fitness> fitnessNamed(const std::string& name) {
  for (const Fitness each : {Fitness::pass, Fitness::warn, Fitness::fail}) {
    if (name == nameOf(each)) return each;
  }
  return {};
}

std::string limitWords(const CommissionCheck& check) {
  const CommissionLimit* by = commissionLimit(check.name);
  if (!check.limit || !by) return "";
  for (const char* yes_or_no : {"granted", "installed", "drawn by"}) {
    if (check.unit == yes_or_no) return shownValue(check.limit, check.unit);
  }
  if (check.unit == "years") return tr("not before it");
  const std::string side = by->at_least ? tr("at least ") : tr("at most ");
  std::string words = side + shownValue(by->warn, check.unit);
  // That of a failure may be raised on this machine: a larger case is kept.
  const std::optional<double> fail = check.verdict == Fitness::fail ? check.limit : by->fail;
  if (fail && *fail != by->warn) {
    words += tr("; to practise at all {}{}", side, shownValue(fail, check.unit));
  }
  return words;
}

// Those of that verdict; none: nothing.
std::string tableOf(const Commissioning& of, const std::string& title, Fitness verdict) {
  const bool passed = verdict == Fitness::pass;
  std::string rows;
  for (const CommissionCheck& check : of.checks) {
    if (check.verdict != verdict) continue;
    const CommissionLimit* by = commissionLimit(check.name);
    rows += "<tr><td class=\"" + std::string(nameOf(verdict)) + "\">" + nameOf(verdict) +
            "</td><td>" + inHtml(check.words) + "<br><small>" + (by ? inHtml(tr(by->reason)) : "") +
            "</small></td><td>" + inHtml(shownValue(check.value, check.unit));
    if (!check.remark.empty()) rows += "<br><small>" + inHtml(check.remark) + "</small>";
    rows += "</td><td>" + inHtml(limitWords(check)) + "</td>";
    rows += passed ? "</tr>\n" : "<td>" + inHtml(check.next) + "</td></tr>\n";
  }
  if (rows.empty()) return rows;
  return "<h2>" + title + "</h2>\n<table width=\"100%\">\n<tr><th width=\"64\"></th><th>" +
         tr("What") + "</th><th>" + tr("Here") + "</th><th width=\"16%\">" + tr("Limit") + "</th>" +
         (passed ? "" : "<th width=\"30%\">" + tr("Next step") + "</th>") + "</tr>\n" + rows +
         "</table>\n";
}

}  // namespace

std::string changeText(const CommissionChange& change) {
  return tr("{}: {} ({}) before, {} ({}) now", change.words,
            shownValue(change.value_before, change.unit), nameOf(change.before),
            shownValue(change.value_now, change.unit), nameOf(change.now));
}

Json toJson(const std::vector<CommissionCheck>& checks) {
  Json rows = Json::array();
  for (const CommissionCheck& check : checks) {
    rows.push_back({{"name", check.name},
                    {"value", orNull(check.value)},
                    {"unit", check.unit},
                    {"limit", orNull(check.limit)},
                    {"verdict", nameOf(check.verdict)},
                    {"next", check.next},
                    {"words", check.words},
                    {"remark", check.remark}});
  }
  return rows;
}

std::optional<std::vector<CommissionCheck>> checksOf(const Json& rows) try {
  std::vector<CommissionCheck> checks;
  for (const Json& row : rows) {
    const auto verdict = fitnessNamed(row.at("verdict").get<std::string>());
    if (!verdict) return {};
    CommissionCheck check{row.at("name"), row.at("words"), {}, row.at("unit"), {}, *verdict,
                          row.at("next"), row.at("remark")};
    if (!row.at("value").is_null()) check.value = row.at("value").get<double>();
    if (!row.at("limit").is_null()) check.limit = row.at("limit").get<double>();
    checks.push_back(std::move(check));
  }
  return checks;
} catch (const Json::exception&) {
  return {};
}

Json toJson(const Commissioning& of) {
  return {{"format", kFormat},
          {"version", kVersion},
          {"checks", toJson(of.checks)},
          {"verdict", nameOf(fitnessOf(of))},
          {"when", of.when},
          {"build", of.build},
          {"machine", of.machine}};
}

Json toJson(const CommissionChanges& changes) {
  if (!changes) return nullptr;
  Json list = Json::array();
  const auto side = [](const std::optional<double>& value, Fitness verdict) {
    return Json{{"value", orNull(value)}, {"verdict", nameOf(verdict)}};
  };
  for (const CommissionChange& change : *changes) {
    list.push_back({{"words", change.words},
                    {"before", side(change.value_before, change.before)},
                    {"now", side(change.value_now, change.now)}});
  }
  return list;
}

Result<Commissioning> readCommissioning(const std::filesystem::path& file) {
  constexpr std::uintmax_t kMostBytes = 1'000'000;
  std::error_code ec;
  if (std::filesystem::file_size(file, ec) > kMostBytes && !ec) {
    return Error{code::kTooLarge, tr("This is no commissioning of ours: it is too large"),
                 file.string(), tr("Commission the workstation anew")};
  }
  const Result<Json> json = readJsonFile(file);
  if (!json) return json.error();
  const auto bad = [&](const char* field) {
    return Error{code::kBadField, tr("This is no commissioning of ours"),
                 file.string() + ": " + field, tr("Commission the workstation anew")};
  };
  try {
    if (json->at("format") != kFormat) return bad("format");
    if (json->at("version") != kVersion) return bad("version");
    auto checks = checksOf(json->at("checks"));
    if (!checks) return bad("checks");
    return Commissioning{
        *std::move(checks), json->at("when"), json->at("build"), json->at("machine"), {}};
  } catch (const Json::exception&) {
    return bad("when");
  }
}

std::string toText(const Commissioning& of, const CommissionChanges& changes) {
  std::string text;
  for (const CommissionCheck& check : of.checks) {
    char line[256];
    std::snprintf(line, sizeof line, "%-4s  %-62s  %s\n", nameOf(check.verdict),
                  check.words.c_str(), shownValue(check.value, check.unit).c_str());
    text += line;
    if (check.verdict != Fitness::pass && !check.next.empty()) text += "      " + check.next + "\n";
  }
  for (const CommissionChange& change : changes.value_or(std::vector<CommissionChange>()))
    text += tr("since last time: {}\n", changeText(change));
  return text + inWords(fitnessOf(of)) + "\n";
}

std::string toHtml(const Commissioning& of, const CommissionChanges& changes) {
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<title>" +
      tr("Commissioning of a Trephine workstation") +
      "</title>\n<style>\n"
      "body{font-family:sans-serif;margin:2em;color:#222}table{border-collapse:collapse;width:100%}"
      "\n"
      "td,th{text-align:left;padding:.3em .6em;border-bottom:1px solid #bbb;vertical-align:top}\n"
      ".pass{color:#166534}.warn{color:#92400e;font-weight:bold}.fail{color:#991b1b;font-weight:"
      "bold}\n"
      "small{color:#555}@media print{body{margin:0}}\n</style></head><body>\n"
      "<h1>" +
      tr("Commissioning of this workstation") + "</h1>\n";
  page += "<p class=\"" + std::string(nameOf(fitnessOf(of))) + "\">" + inWords(fitnessOf(of)) +
          "</p>\n";
  constexpr const char* kLine = " ____________";
  page += "<p>" + tr("Workstation") + kLine + " &nbsp; " + tr("Room") + kLine + " &nbsp; " +
          tr("Checked by") + kLine + "</p>\n";
  page += "<p>" + inHtml(of.when) + " &middot; Trephine " + inHtml(of.build) + " &middot; " +
          inHtml(of.machine) + "</p>\n";
  page += tableOf(of, tr("What keeps trainees from practising"), Fitness::fail) +
          tableOf(of, tr("What could be better"), Fitness::warn) +
          tableOf(of, tr("What is well"), Fitness::pass);
  page += "<h2>" + tr("Since the last commissioning") + "</h2>\n";
  if (!changes) page += "<p>" + tr("There is none to compare with.") + "</p>\n";
  if (changes && changes->empty()) page += "<p>" + tr("Nothing has changed.") + "</p>\n";
  for (const CommissionChange& change : changes.value_or(std::vector<CommissionChange>())) {
    page += "<p>" + inHtml(changeText(change)) + "</p>\n";
  }
  return page + "<p><small>" + tr(kPurpose) + ".</small></p>\n</body></html>\n";
}

}  // namespace trephine
