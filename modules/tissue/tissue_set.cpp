#include "tissue/tissue_set.h"

#include <algorithm>
#include <utility>

#include "base/tr.h"
#include "tissue/codes.h"

namespace trephine {

namespace {

Error bad(const std::string& file, const std::string& field, const std::string& what,
          const std::string& next = tr("Correct that value")) {
  return Error{code::kBadTissue, what, file + ": " + field, next};
}

std::string range(const Tissue& t) {
  return std::to_string(t.hu_min) + ".." + std::to_string(t.hu_max);
}

bool sameVoxels(const Tissue& a, const Tissue& b) {
  return inSamePlace(a, b) && a.hu_min <= b.hu_max && b.hu_min <= a.hu_max;
}

// Numbers that contradict each other, or that one needs which the tissue lacks.
Status checkTogether(const std::string& file, const std::string& field, const Tissue& t) {
  const auto valueOf = [](const std::optional<SourcedNumber>& n) { return n ? n->value : 0.0; };
  if (t.cutting_J_per_mm3 && t.toughness_J_per_m2) {
    return bad(
        file, field + ".toughness_J_per_m2",
        tr("Cutting '{}' costs {} J/m\u00b2 by area and {} J/mm\u00b3 by volume: one contradicts "
           "the other",
           t.id, exactNumber(t.toughness_J_per_m2->value), exactNumber(t.cutting_J_per_mm3->value)),
        tr("Give toughness_J_per_m2 for soft tissue, or cutting_J_per_mm3"));
  }
  if (!t.cutting_J_per_mm3 && !t.toughness_J_per_m2) {
    return bad(file, field + ".cutting_J_per_mm3", tr("Nothing says what cutting '{}' costs", t.id),
               tr("Give toughness_J_per_m2 for soft tissue, or cutting_J_per_mm3"));
  }
  const double rupture_N = valueOf(t.rupture_N), rupture_mm = valueOf(t.rupture_mm);
  if (rupture_N > 0.0 && !(rupture_mm > 0.0) && !(t.stiffness_N_per_m.value > 0.0)) {
    return bad(file, field + ".rupture_N",
               tr("'{}' gives way at {} N, and nothing says how far it lets itself be pressed in",
                  t.id, exactNumber(rupture_N)),
               tr("Give rupture_mm, or a stiffness above 0"));
  }
  if (rupture_mm > 0.0 && !(rupture_N > 0.0)) {
    return bad(file, field + ".rupture_mm",
               tr("'{}' gives way after {} mm, and nothing says at which force", t.id,
                  exactNumber(rupture_mm)),
               tr("Give rupture_N"));
  }
  const double relaxes = valueOf(t.relaxation_share), within_s = valueOf(t.relaxation_s);
  if ((relaxes > 0.0) != (within_s > 0.0)) {
    return bad(file, field + (relaxes > 0.0 ? ".relaxation_share" : ".relaxation_s"),
               tr("'{}' relaxes by {} within {} s: one of the two is 0 or missing", t.id,
                  exactNumber(relaxes), exactNumber(within_s)),
               tr("Give both above 0, relaxation_share and relaxation_s, or none"));
  }
  return {};
}

void readMechanics(JsonReader mechanics, Tissue& tissue) {
  for (const TissueNumber& number : kTissueNumbers) {
    const FieldRow row = number.row();
    if (row.given == Given::may_be && !mechanics.has(row.key)) continue;
    // As it stands: what contradicts another is refused, and takes no place of it.
    const SourcedNumber read = readSourced(mechanics.object(row.key), row.range);
    std::visit([&](auto member) { tissue.*member = read; }, number.in_set);
  }
  readFields(mechanics, kCuttingFields, tissue);
  if (mechanics.has("solid")) tissue.solid = mechanics.boolean("solid", false);
}

Json mechanicsOf(const Tissue& tissue) {
  Json mechanics;
  for (const TissueNumber& row : kTissueNumbers) {
    const SourcedNumber* number = row.of(tissue);
    if (number) mechanics[row.key] = toJson(*number);
  }
  writeFields(mechanics, kCuttingFields, tissue);
  if (tissue.solid) mechanics["solid"] = *tissue.solid;
  return mechanics;
}

}  // namespace

bool inSamePlace(const Tissue& a, const Tissue& b) {
  return a.structure == b.structure && (!a.structure.empty() || a.label == b.label);
}

const Tissue* TissueSet::find(const std::string& id) const {
  for (const Tissue& tissue : tissues) {
    if (tissue.id == id) return &tissue;
  }
  return nullptr;
}

Status validate(const TissueSet& set, const std::string& file) {
  if (set.tissues.empty() || set.tissues.size() > std::size_t(kMaxTissues)) {
    return bad(file, "tissues",
               tr("A set has 1 to {} tissues, this one has {}", kMaxTissues, set.tissues.size()));
  }
  for (std::size_t i = 0; i < set.tissues.size(); ++i) {
    const Tissue& t = set.tissues[i];
    const std::string field = "tissues[" + std::to_string(i) + "]";
    if (t.id.empty()) return bad(file, field + ".id", tr("The id is empty"));
    if (t.hu_min > t.hu_max || !kHuRange.holds(t.hu_min) || !kHuRange.holds(t.hu_max)) {
      return bad(file, field + ".hu", tr("The HU range {} is not possible", range(t)),
                 tr("Give the lower value first, within -32768..32767"));
    }
    if (t.hu_source.empty()) {
      return bad(file, field + ".hu_source", tr("The HU range {} has no source", range(t)),
                 tr("Cite one, or write \"tuned here, uncited\""));
    }
    if (t.label && !kLabelRange.holds(*t.label)) {
      return bad(file, field + ".label", tr("The label {} is not between 1 and 255", *t.label),
                 tr("Give a label of the label map, or none for every voxel"));
    }
    if (t.shell && t.structure.empty()) {
      return bad(file, field + ".shell", tr("The shell has no structure that it stands in for"),
                 tr("Give the tissue a structure"));
    }
    if (t.shell && (t.shell->of.empty() || !kShellRange.holds(t.shell->thickness_mm))) {
      return bad(file, field + ".shell",
                 tr("The shell of '{}', {} mm thick, is not possible", t.shell->of,
                    exactNumber(t.shell->thickness_mm)),
                 tr("Name a structure and a thickness of {}", kShellRange.words()));
    }
    if (t.within == t.id || (!t.within.empty() && !set.find(t.within))) {
      return bad(file, field + ".within", tr("'{}' cannot be enclosed by '{}'", t.id, t.within),
                 tr("Name another tissue of the set, or none"));
    }
    const Tissue* around = &t;
    for (std::size_t n = 0; around && n < set.tissues.size(); ++n) {
      around = around->within.empty() ? nullptr : set.find(around->within);
      if (around != &t) continue;
      return bad(
          file, field + ".within",
          tr("'{}' is enclosed by '{}', which lies inside of '{}' itself", t.id, t.within, t.id),
          tr("Name a tissue that lies farther out, or none"));
    }
    if (!kShareRange.holds(t.opacity)) {
      return bad(file, field + ".opacity",
                 tr("The opacity {} is not between 0 and 1", exactNumber(t.opacity)));
    }
    for (int c = 0; c < 3; ++c) {
      if (!kShareRange.holds(t.colour[c])) {
        return bad(file, field + ".colour",
                   tr("The colour value {} is not between 0 and 1", exactNumber(t.colour[c])));
      }
    }
    for (const TissueNumber& row : kTissueNumbers) {
      const SourcedNumber* number = row.of(t);
      if (!number) continue;
      const std::string of = field + ".mechanics." + row.key;
      if (Status s = checkSourced(file, of, row.row().range, *number); !s) return s;
    }
    if (Status s = checkTogether(file, field + ".mechanics", t); !s) return s;
    for (std::size_t j = 0; j < i; ++j) {
      const Tissue& other = set.tissues[j];
      if (other.id == t.id) return bad(file, field + ".id", tr("The id '{}' is used twice", t.id));
      if (sameVoxels(other, t)) {
        return bad(file, field + ".hu",
                   tr("The HU ranges {} of '{}' and {} of '{}' overlap", range(other), other.id,
                      range(t), t.id),
                   tr("Separate the ranges or give them different structures or labels"));
      }
    }
  }
  return {};
}

Result<TissueSet> parseTissueSet(const Json& json, const std::string& file) {
  JsonReader reader(json, file);
  reader.format("trephine.tissues", 1);
  TissueSet set;
  set.name = reader.text("name");
  set.elsewhere_file = reader.text("elsewhere", "");
  for (JsonReader& item : reader.objects("tissues", kMaxTissues)) {
    Tissue t;
    readFields(item, kTissueFields, t);
    const std::vector<std::int64_t> hu = item.integers("hu", 2, kHuRange);
    t.hu_min = int(hu[0]);
    t.hu_max = int(hu[1]);
    t.hu_source = sourceIn(item, "hu_source");
    if (item.has("label")) t.label = int(item.integer("label", kLabelRange));
    if (item.has("shell")) {
      JsonReader shell = item.object("shell");
      readFields(shell, kShellFields, t.shell.emplace());
    }
    readMechanics(item.object("mechanics"), t);
    set.tissues.push_back(std::move(t));
  }
  if (Status status = reader.finish(); !status) return status.error();
  if (Status status = validate(set, file); !status) return status.error();
  return set;
}

Result<TissueSet> readTissueSet(const std::filesystem::path& file) {
  Result<Json> json = readJsonFile(file, Progress(), kMostWrittenBytes);
  if (!json) return json.error();
  Result<TissueSet> set = parseTissueSet(*json, file.string());
  if (set && !set->elsewhere_file.empty()) {
    set->elsewhere_file = (file.parent_path() / set->elsewhere_file).lexically_normal().string();
  }
  return set;
}

Json toJson(const TissueSet& set) {
  Json tissues = Json::array();
  for (const Tissue& t : set.tissues) {
    Json item;
    writeFields(item, kTissueFields, t);
    item["hu"] = {t.hu_min, t.hu_max};
    item["hu_source"] = t.hu_source;
    item["mechanics"] = mechanicsOf(t);
    if (t.label) item["label"] = *t.label;
    if (t.shell) writeFields(item["shell"], kShellFields, *t.shell);
    tissues.push_back(std::move(item));
  }
  return {{"format", "trephine.tissues"}, {"version", 1}, {"name", set.name}, {"tissues", tissues}};
}

std::string tissueFieldsPage() {
  std::string page = schemaHead() + schemaLines<Tissue>("tissue", kTissueFields) +
                     schemaLines<Tissue::Shell>("tissue, `shell`", kShellFields);
  for (const TissueNumber& number : kTissueNumbers) {
    page += schemaLine("`mechanics`", number.row(), "sourced number", "none");
  }
  return page + schemaLines<Tissue>("`mechanics`", kCuttingFields) + sourcedFieldsPage();
}

TissueTable tissueTable(const TissueSet& set) {
  TissueTable table;
  table.count = std::int32_t(std::min(set.tissues.size(), table.classes.size()));
  for (std::size_t i = 0; i < std::size_t(table.count); ++i) {
    const Tissue& t = set.tissues[i];
    TissueClass& c = table.classes[i];
    for (const TissueNumber& number : kTissueNumbers) c.*number.in_tick = number.valueOf(t);
    c.hu_min = t.hu_min;
    c.hu_max = t.hu_max;
    c.cuttable = t.cuttable ? 1 : 0;
    c.label = t.label.value_or(t.structure.empty() ? 0 : -1);  // -1: not placed in a case yet
    c.solid = t.isSolid() ? 1 : 0;
  }
  return table;
}

LabelRows::LabelRows(const TissueTable& table) {
  for (int i = 0; i < table.count; ++i) {
    const std::int32_t named = table.classes[std::size_t(i)].label;
    if (named < 1 || named > 255 || row[std::size_t(named)] != 0) continue;
    row[std::size_t(named)] = std::uint8_t(count);
    label[std::size_t(count++)] = std::uint8_t(named);
  }
}

}  // namespace trephine
