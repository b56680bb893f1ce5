#include "script/script.h"

#include <fmt/format.h>

#include <QFile>
#include <map>
#include <optional>
#include <vector>

#include "ui_kit/parts.h"

namespace trocar::trainer {
namespace {

struct Arity {
  int least, most;
};
const std::map<QString, Arity>& verbs() {
  static const std::map<QString, Arity> all = {
      {"click", {1, 3}},         {"double-click", {1, 3}}, {"right-click", {1, 3}}, {"drag", {5, 7}},
      {"wheel", {2, 4}},         {"wheel-until", {5, 7}},  {"key", {1, 2}},         {"key-until", {5, 7}},
      {"hold", {1, 1}},          {"release", {1, 1}},      {"type", {1, 1}},        {"choose", {2, 2}},
      {"set", {2, 2}},           {"wait", {1, 1}},         {"wait-for", {3, 5}},    {"expect", {3, 5}},
      {"expect-pixels", {4, 6}}, {"resize", {2, 2}},       {"screenshot", {1, 2}},  {"end-server", {1, 1}},
      {"end-window", {0, 0}},    {"close-window", {0, 0}}, {"reset-watch", {0, 0}}, {"print", {1, 16}},
      {"expect-whole", {0, 0}},
  };
  return all;
}

/// Indices of numeric arguments of a step.
const std::map<QString, std::vector<int>>& numbers() {
  static const std::map<QString, std::vector<int>> all = {
      {"click", {1, 2}},
      {"double-click", {1, 2}},
      {"right-click", {1, 2}},
      {"drag", {1, 2, 3, 4, 6}},
      {"wheel", {1, 2, 3}},
      {"wheel-until", {1, 6}},
      {"key", {1}},
      {"key-until", {1, 6}},
      {"wait", {0}},
      {"wait-for", {4}},
      {"resize", {0, 1}},
      {"expect", {4}},
      {"expect-pixels", {2, 3, 5}},
  };
  return all;
}

/// The first argument that should be a number but is not.
std::optional<QString> find_no_number(const QString& verb, const QStringList& words) {
  const auto found = numbers().find(verb);
  if (found == numbers().end()) return std::nullopt;
  for (const int at : found->second) {
    bool is_number = true;
    if (at < words.size()) words[at].toDouble(&is_number);
    if (!is_number) return words[at];
  }
  return std::nullopt;
}

/// The operator of a comparison if it is not valid.
std::optional<QString> find_no_comparison(const QString& verb, const QStringList& words) {
  static const std::map<QString, int> places = {{"wheel-until", 3}, {"key-until", 3}, {"wait-for", 1}, {"expect", 1}};
  static const QStringList comparisons = {"is", "isnt", "has", "<", ">", "<=", ">="};
  const auto found = places.find(verb);
  if (found == places.end() || comparisons.contains(words[found->second])) return std::nullopt;
  return words[found->second];
}

/// Words of a line up to a comment; empty if a quotation is not terminated.
std::optional<QStringList> words_of(const QString& line) {
  QStringList words;
  QString word;
  bool is_quoted = false, has_word = false;
  for (int at = 0; at < line.size(); ++at) {
    const QChar c = line[at];
    // A colour starts with the same character.
    const bool is_comment =
        c == '#' && !has_word && !is_quoted && (words.isEmpty() || at + 1 == line.size() || line[at + 1].isSpace());
    if (is_comment) break;
    if (c == '"') {
      is_quoted = !is_quoted;
      has_word = true;
    } else if (!is_quoted && c.isSpace()) {
      if (has_word) words.append(word);
      word.clear();
      has_word = false;
    } else {
      word.append(c);
      has_word = true;
    }
  }
  if (is_quoted) return std::nullopt;
  if (has_word) words.append(word);
  return words;
}

}  // namespace

Result<std::vector<ScriptStep>> parse_script(const QString& text, const QString& name) {
  std::vector<ScriptStep> steps;
  int number = 0;
  for (const QString& line : text.split('\n')) {
    ++number;
    const std::string where = to_std(QStringLiteral("%1:%2").arg(name).arg(number));
    auto words = words_of(line);
    if (!words) return fail("unterminated quotation", where, "add \" at its end");
    if (words->isEmpty()) continue;
    const QString verb = words->takeFirst();
    const auto found = verbs().find(verb);
    if (found == verbs().end())
      return fail(fmt::format("unknown step \"{}\"", to_std(verb)), where, "see trocar-trainer --help");
    if (words->size() < found->second.least || words->size() > found->second.most)
      return fail(fmt::format("\"{}\" has {} arguments", to_std(verb), words->size()), where,
                  "see trocar-trainer --help");
    if (const auto wrong = find_no_number(verb, *words))
      return fail(fmt::format("\"{}\" is not a number", to_std(*wrong)), where, "see trocar-trainer --help");
    if (const auto wrong = find_no_comparison(verb, *words))
      return fail(fmt::format("\"{}\" is not a comparison", to_std(*wrong)), where,
                  "write is, isnt, has, <, >, <= or >=");
    steps.push_back({name, number, verb, *words});
  }
  if (steps.empty()) return fail("the script contains no steps", to_std(name), "see trocar-trainer --help");
  return steps;
}

Result<std::vector<ScriptStep>> load_script(const std::filesystem::path& path) {
  QFile file(to_qt(path.string()));
  if (!file.open(QIODevice::ReadOnly)) return fail("cannot read the script", path.string(), "check its name");
  constexpr qint64 kMostBytes = 1 << 20;
  if (file.size() > kMostBytes) return fail("the script is larger than 1 MiB", path.string(), "is it a script?");
  return parse_script(QString::fromUtf8(file.readAll()), to_qt(path.filename().string()));
}

}  // namespace trocar::trainer
