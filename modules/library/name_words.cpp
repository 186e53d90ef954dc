#include "library/name_words.h"

#include <QChar>
#include <QList>
#include <QString>
#include <algorithm>
#include <array>

#include "base/tr.h"
#include "base/utf8.h"
#include "library/codes.h"
#include "volume/label_map.h"

namespace trephine {

namespace {

// More than a name has; each costs a hash.
constexpr std::size_t kMostParts = 5;
constexpr std::size_t kMostFileNames = 40;
// Shorter words are part of too many other names; of scripts whose words are shorter, too.
constexpr int kShortestPart = 3, kShortestHan = 2;

constexpr std::array<std::pair<IdentityKind, const char*>, 6> kKinds{
    {{IdentityKind::patient_name, "patient_name"},
     {IdentityKind::patient_id, "patient_id"},
     {IdentityKind::accession, "accession"},
     {IdentityKind::study_id, "study_id"},
     {IdentityKind::folder, "folder"},
     {IdentityKind::file, "file"}}};

QString fromUtf8(std::string_view text) {
  return QString::fromUtf8(text.data(), qsizetype(text.size()));
}

QString fromUcs4(const std::u32string& text) {
  return QString::fromUcs4(text.data(), qsizetype(text.size()));
}

std::u32string ucs4(const QString& text) {
  std::u32string out;
  for (const uint c : text.toUcs4()) out += char32_t(c);
  return out;
}

std::size_t lengthOf(const std::string& text) {
  return std::size_t(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

// Words in these are not parted by blanks.
bool isHan(char32_t c) {
  const QChar::Script script = QChar::script(c);
  return script == QChar::Script_Han || script == QChar::Script_Hiragana ||
         script == QChar::Script_Katakana || script == QChar::Script_Hangul ||
         script == QChar::Script_Bopomofo;
}

bool isAccent(char32_t c) {
  return c >= 0x300 && c <= 0x36F;
}

// Characters as they are compared, but for their case.
std::u32string plain(std::string_view text) {
  std::u32string out = ucs4(fromUtf8(text).normalized(QString::NormalizationForm_KD));
  std::erase_if(
      out, [](char32_t c) { return isAccent(c) || QChar::category(c) == QChar::Other_Format; });
  out = ucs4(fromUcs4(out).normalized(QString::NormalizationForm_C));
  for (char32_t& c : out) {
    if (c >= 0x30A1 && c <= 0x30F6) c -= 0x60;  // katakana to hiragana
  }
  return out;
}

bool isPartOfWord(char32_t c) {
  return QChar::isLetterOrNumber(c) || QChar::isMark(c);
}

bool partsWords(char32_t a, char32_t b) {
  constexpr char32_t kLongVowel = 0x30FC;  // of either kana, by Unicode of no script
  if (QChar::isMark(b) || a == kLongVowel || b == kLongVowel) return false;
  if (QChar::isDigit(a) != QChar::isDigit(b)) return true;
  if (QChar::isDigit(a)) return false;
  if (QChar::isLower(a) && QChar::isUpper(b)) return true;
  return (isHan(a) || isHan(b)) && QChar::script(a) != QChar::script(b);
}

// A German umlaut is written as one letter or as two.
std::vector<std::string> spellings(std::string_view text) {
  const QString folded = fromUtf8(text).normalized(QString::NormalizationForm_C).toCaseFolded();
  QString two_letters = folded;
  for (const auto& [one, two] : {std::pair(u"ä", u"ae"), {u"ö", u"oe"}, {u"ü", u"ue"}}) {
    two_letters.replace(QString::fromUtf16(one), QString::fromUtf16(two));
  }
  std::vector<std::string> both{std::string(text)};
  if (two_letters != folded) both.push_back(two_letters.toStdString());
  return both;
}

std::string joined(const std::vector<std::string>& words, const char* between = "") {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

// Two kinds of keys: of what a name may not be, and of what it may not hold.
std::string wholeKey(std::vector<std::string> words) {
  std::ranges::sort(words);
  return "is " + joined(words, " ");
}

std::string partKey(const std::string& part) {
  return "holds " + part;
}

// Files that are counted have one key: "is any ct # dcm".
std::string numberedKey(const std::vector<std::string>& words) {
  std::vector<std::string> some;
  for (const std::string& word : words) {
    const bool number = std::ranges::all_of(word, [](char c) { return c >= '0' && c <= '9'; });
    if (!number) some.push_back(word);
    if (number && (some.empty() || some.back() != "#")) some.push_back("#");
  }
  return "is any " + joined(some, " ");
}

// The characters of a word.
std::vector<std::string> charactersOf(const std::string& word) {
  std::vector<std::string> characters;
  for (const char c : word) {
    if ((c & 0xC0) != 0x80) characters.emplace_back();
    characters.back() += c;
  }
  return characters;
}

bool isHanWord(const std::string& word) {
  const std::u32string text = ucs4(fromUtf8(word));
  return !text.empty() && isHan(text[0]);
}

class Keys {
 public:
  explicit Keys(SourceKeys& keys) : keys_(keys) {}

  void addWhole(const std::string& text, IdentityKind kind) {
    for (const std::string& spelling : spellings(text)) {
      if (const auto words = wordsOf(spelling); !words.empty()) put(wholeKey(words), kind);
    }
  }
  // What no name may hold, where it is long enough to be told from other words.
  void addPart(const std::string& part, IdentityKind kind) {
    const bool han = isHanWord(part);
    const int length = int(lengthOf(part));
    if (length < (han ? kShortestHan : kShortestPart)) return;
    if (han) keys_.lengths.insert(length);
    put(partKey(part), kind);
  }
  void addId(const std::string& text, IdentityKind kind) {
    addWhole(text, kind);
    const std::vector<std::string> words = wordsOf(text);
    keys_.most_words = std::max(keys_.most_words, int(std::min<std::size_t>(words.size(), 8)));
    addPart(joined(words), kind);
  }
  void addName(const std::string& name) {
    for (std::size_t at = 0; at <= name.size();) {
      const std::size_t end = std::min(name.find('=', at), name.size());
      const std::string one = name.substr(at, end - at);  // one way of writing it
      addWhole(one, kPatient);
      for (const std::string& spelling : spellings(one)) addNameParts(wordsOf(spelling));
      at = end + 1;
    }
  }
  void addFiles(const std::set<std::string>& files) {
    std::map<std::string, std::vector<std::string>> alike;  // by their key as numbered ones
    for (const std::string& file : files) {
      const std::string stem = file.substr(0, file.find_last_of('.'));
      for (const std::string& name : {file, stem.empty() ? file : stem}) {
        const auto words = wordsOf(name);
        if (!words.empty()) alike[numberedKey(words)].push_back(name);
      }
    }
    std::size_t count = 0;
    for (const auto& [numbered, names] : alike) {
      if (++count > kMostFileNames) break;
      if (std::set(names.begin(), names.end()).size() > 1) {
        put(numbered, IdentityKind::file);
      } else {
        addWhole(names[0], IdentityKind::file);
      }
    }
  }

 private:
  static constexpr IdentityKind kPatient = IdentityKind::patient_name;

  void addNameParts(std::vector<std::string> words) {
    if (words.size() > kMostParts) words.resize(kMostParts);
    for (std::size_t a = 0; a < words.size(); ++a) {
      addPart(words[a], kPatient);
      for (std::size_t b = 0; b < words.size(); ++b) {
        if (a != b) addPart(words[a] + words[b], kPatient);
      }
    }
  }
  // The kinds stand in the order of what a person should hear first.
  void put(const std::string& key, IdentityKind kind) {
    const auto [at, is_new] = keys_.keys.emplace(key, kind);
    if (!is_new) at->second = std::min(at->second, kind);
  }

  SourceKeys& keys_;
};

}  // namespace

std::vector<std::string> wordsOf(std::string_view text) {
  std::vector<std::string> words;
  std::u32string word;
  const auto end = [&] {
    // Folding makes some letters two.
    if (!word.empty()) words.push_back(fromUcs4(word).toCaseFolded().toStdString());
    word.clear();
  };
  for (const char32_t c : plain(text)) {
    if (!isPartOfWord(c) || (!word.empty() && partsWords(word.back(), c))) end();
    if (isPartOfWord(c)) word += c;
  }
  end();
  return words;
}

Result<std::string> caseNameFrom(std::string_view text) {
  const auto bad = [](const std::string& what) {
    return Error{code::kBadName, what, "",
                 tr("Give it one line of at most {} characters", kLongestCaseName)};
  };
  if (!isUtf8(text)) return bad(tr("The name is no valid text"));
  const std::u32string given = ucs4(fromUtf8(text));
  constexpr char32_t kJoiner = 0x200D, kNonJoiner = 0x200C;  // within words of some scripts
  const bool hidden = std::ranges::any_of(
      given, [&](char32_t c) { return !QChar::isPrint(c) && c != kJoiner && c != kNonJoiner; });
  if (hidden)
    return bad(tr("The name holds characters that cannot be seen, or more than one line"));
  const QString name = fromUcs4(given).simplified();
  if (ucs4(name).size() > std::size_t(kLongestCaseName)) return bad(tr("The name is too long"));
  if (wordsOf(name.toStdString()).empty()) return bad(tr("The name holds no letter and no number"));
  return name.toStdString();
}

std::string foldedName(std::string_view name) {
  const QString folded =
      fromUtf8(name).normalized(QString::NormalizationForm_KC).toCaseFolded().simplified();
  std::u32string visible = ucs4(folded);
  std::erase_if(visible, [](char32_t c) { return QChar::category(c) == QChar::Other_Format; });
  return fromUcs4(visible).toStdString();
}

SourceKeys sourceKeys(const SourceIdentity& source) {
  SourceKeys found;
  Keys keys(found);
  for (const auto& [kind, texts] : source.texts) {
    if (kind == IdentityKind::file) {
      keys.addFiles(texts);
      continue;
    }
    for (const std::string& text : texts) {
      switch (kind) {
        case IdentityKind::patient_name:
          keys.addName(text);
          break;
        case IdentityKind::patient_id:
        case IdentityKind::accession:
          keys.addId(text, kind);
          break;
        default:
          keys.addWhole(text, kind);
      }
    }
  }
  return found;
}

std::set<std::string> nameKeys(std::string_view name, int most_words,
                               const std::set<int>& lengths) {
  std::set<std::string> keys;
  for (const std::string& spelling : spellings(name)) {
    const std::vector<std::string> words = wordsOf(spelling);
    keys.insert(wholeKey(words));
    keys.insert(numberedKey(words));
    for (std::size_t from = 0; from < words.size(); ++from) {
      std::string run;
      for (std::size_t n = from; n < words.size() && n < from + std::size_t(most_words); ++n) {
        run += words[n];
        keys.insert(partKey(run));
      }
      if (!isHanWord(words[from])) continue;
      const std::vector<std::string> characters = charactersOf(words[from]);
      for (const int length : lengths) {
        for (std::size_t at = 0; at + std::size_t(length) <= characters.size(); ++at) {
          std::string piece;
          for (int n = 0; n < length; ++n) piece += characters[at + std::size_t(n)];
          keys.insert(partKey(piece));
        }
      }
    }
  }
  return keys;
}

std::optional<IdentityKind> toldBy(std::string_view name, const SourceKeys& source) {
  std::optional<IdentityKind> told;
  for (const std::string& key : nameKeys(name, source.most_words, source.lengths)) {
    const auto found = source.keys.find(key);
    if (found != source.keys.end() && (!told || found->second < *told)) told = found->second;
  }
  return told;
}

int hideNames(Segmentation& segmentation, const SourceKeys& source) {
  int hidden = 0;
  for (Segmentation::Segment& segment : segmentation.segments) {
    const auto told = toldBy(segment.name, source);
    if (!told || !tellsPatient(*told)) continue;
    const std::string label = "label " + std::to_string(int(segment.value));
    segment.name = label;
    const auto twice = [&](const Segmentation::Segment& other) {
      return &other != &segment && sameName(other.name, segment.name);
    };
    for (int n = 2; std::ranges::any_of(segmentation.segments, twice); ++n) {
      segment.name = label + " (" + std::to_string(n) + ")";
    }
    ++hidden;
  }
  return hidden;
}

int hideNamesOf(Segmentation& segmentation, const SourceIdentity& source) {
  return hideNames(segmentation, sourceKeys(source));
}

bool tellsPatient(IdentityKind kind) {
  return kind == IdentityKind::patient_name || kind == IdentityKind::patient_id ||
         kind == IdentityKind::accession;
}

Error identityError(IdentityKind told) {
  std::string what;
  switch (told) {
    case IdentityKind::patient_name:
      what = tr("The name holds the patient's name, or a part of it");
      break;
    case IdentityKind::patient_id:
      what = tr("The name holds the patient's ID");
      break;
    case IdentityKind::accession:
      what = tr("The name holds the study's accession number");
      break;
    case IdentityKind::study_id:
      what = tr("The name is the study's ID");
      break;
    case IdentityKind::folder:
      what = tr("The name is that of a folder that the CT came from");
      break;
    case IdentityKind::file:
      what = tr("The name is that of a file that the CT came from");
      break;
  }
  return Error{code::kNameIsIdentity, what, "", tr("Choose one that tells nothing of the patient")};
}

const char* identityKindName(IdentityKind kind) {
  for (const auto& [one, name] : kKinds) {
    if (one == kind) return name;
  }
  return "";
}

std::optional<IdentityKind> identityKindNamed(std::string_view name) {
  for (const auto& [kind, text] : kKinds) {
    if (name == text) return kind;
  }
  return std::nullopt;
}

}  // namespace trephine
