#include "architecture/definitions.h"

#include <algorithm>
#include <optional>

#include "architecture/source_files.h"
#include "core/text.h"

namespace trocar::architecture {
namespace {

struct Token {
  std::string text;
  int line = 0;
};
using Tokens = std::vector<Token>;

bool is_word_start(char c) {
  return ascii::is_letter(c) || c == '_';
}

/// Splits a source into words and punctuation. Leaves out comments, literals' contents, preprocessor lines, and all but
/// the first branch of each #if.
class Lexer {
 public:
  explicit Lexer(std::string_view source) : source_(source) {}

  Tokens run() {
    while (at_ < source_.size()) step();
    return std::move(tokens_);
  }

 private:
  char peek(std::size_t ahead = 0) const { return at_ + ahead < source_.size() ? source_[at_ + ahead] : '\0'; }
  void advance(std::size_t count = 1) {
    for (; count > 0 && at_ < source_.size(); --count) {
      if (source_[at_] == '\n') {
        ++line_;
        is_line_start_ = true;
      }
      ++at_;
    }
  }
  void skip_to(std::string_view end) {
    const std::size_t found = source_.find(end, at_);
    advance(found == std::string_view::npos ? source_.size() - at_ : found + end.size() - at_);
  }
  void push(std::string text) {
    if (hidden_ == 0) tokens_.push_back({std::move(text), line_});
  }

  void step() {
    const char c = peek();
    if (ascii::is_space(c)) return advance();
    if (c == '/' && peek(1) == '/') return skip_line();
    if (c == '/' && peek(1) == '*') return skip_to("*/");
    if (c == '#' && is_line_start_) return directive();
    is_line_start_ = false;
    if (c == 'R' && peek(1) == '"') return raw_string();
    if (c == '"' || c == '\'') return literal(c);
    if (is_word_start(c)) return word();
    if (ascii::is_digit(c)) return number();
    if (c == ':' && peek(1) == ':') {
      push("::");
      return advance(2);
    }
    push(std::string(1, c));
    advance();
  }

  /// To the end of the line, over lines that end in a backslash.
  void skip_line() {
    while (at_ < source_.size() && peek() != '\n') advance(peek() == '\\' ? 2 : 1);
  }

  void directive() {
    const std::size_t begin = at_;
    skip_line();
    std::string_view text = source_.substr(begin, at_ - begin);
    text.remove_prefix(std::min(text.find_first_not_of("# \t"), text.size()));
    if (text.starts_with("if")) {
      branches_.push_back(false);
    } else if (text.starts_with("el") && !branches_.empty()) {
      branches_.back() = true;
    } else if (text.starts_with("endif") && !branches_.empty()) {
      branches_.pop_back();
    }
    hidden_ = std::count(branches_.begin(), branches_.end(), true);
  }

  void raw_string() {
    const std::size_t open = source_.find('(', at_);
    if (open == std::string_view::npos) return advance();
    const std::string end = ")" + std::string(source_.substr(at_ + 2, open - at_ - 2)) + "\"";
    push("\"");
    skip_to(end);
  }

  void literal(char quote) {
    push("\"");
    for (advance(); at_ < source_.size() && peek() != quote && peek() != '\n'; advance())
      if (peek() == '\\') advance();
    advance();
  }

  void word() {
    const std::size_t begin = at_;
    while (is_word(peek())) advance();
    push(std::string(source_.substr(begin, at_ - begin)));
  }

  /// With digit separators, which look like character literals.
  void number() {
    while (is_word(peek()) || (peek() == '\'' && is_word(peek(1)))) advance();
    push("0");
  }

  std::string_view source_;
  std::size_t at_ = 0;
  int line_ = 1;
  bool is_line_start_ = true;
  std::vector<bool> branches_;  ///< Of the open #ifs: is a branch after the first.
  std::ptrdiff_t hidden_ = 0;   ///< How many of them are.
  Tokens tokens_;
};

struct Scope {
  enum class Kind { kNamespace, kType, kOther } kind = Kind::kOther;
  std::string name;  ///< Empty: `extern "C"`.
};

/// Index behind the bracket that closes the one at `open`.
std::size_t behind_bracket(const Tokens& tokens, std::size_t open, std::string_view opening, std::string_view closing) {
  int depth = 0;
  for (std::size_t n = open; n < tokens.size(); ++n) {
    depth += tokens[n].text == opening ? 1 : 0;
    depth -= tokens[n].text == closing ? 1 : 0;
    if (depth == 0) return n + 1;
  }
  return tokens.size();
}

/// The statement without template heads, attributes and what stands in parentheses.
Tokens bare(const Tokens& statement) {
  Tokens result;
  for (std::size_t n = 0; n < statement.size();) {
    const std::string& text = statement[n].text;
    if (text == "template" && n + 1 < statement.size() && statement[n + 1].text == "<") {
      n = behind_bracket(statement, n + 1, "<", ">");
    } else if (text == "[") {
      n = behind_bracket(statement, n, "[", "]");
    } else if (text == "(") {
      n = behind_bracket(statement, n, "(", ")");
      result.push_back({"()", 0});
    } else {
      result.push_back(statement[n++]);
    }
  }
  return result;
}

bool is_type_keyword(const Token& token) {
  return token.text == "class" || token.text == "struct" || token.text == "union" || token.text == "enum";
}

/// Reads `a::b` at `n` and moves behind it.
std::string read_name(const Tokens& tokens, std::size_t& n) {
  std::string name;
  for (; n < tokens.size(); ++n) {
    const std::string& text = tokens[n].text;
    const bool wants_word = name.empty() || name.ends_with("::");
    if (text == "::" ? wants_word && !name.empty() : !wants_word || !is_word_start(text.front())) break;
    name += text;
  }
  return name;
}

/// What the brace opens that stands behind a statement.
Scope open_scope(const Tokens& statement) {
  const Tokens tokens = bare(statement);
  if (tokens.empty()) return {};
  std::size_t n = tokens[0].text == "inline" && tokens.size() > 1 ? 1 : 0;
  if (tokens[n].text == "namespace") {
    std::string name = read_name(tokens, ++n);
    return name.empty() ? Scope{} : Scope{Scope::Kind::kNamespace, std::move(name)};
  }
  if (tokens[0].text == "extern" && tokens.size() == 2 && tokens[1].text == "\"") return {Scope::Kind::kNamespace, {}};
  const auto keyword = std::find_if(tokens.begin(), tokens.end(), is_type_keyword);
  if (keyword == tokens.end()) return {};
  n = static_cast<std::size_t>(keyword - tokens.begin()) + 1;
  while (n < tokens.size() && (is_type_keyword(tokens[n]) || tokens[n].text == "alignas" || tokens[n].text == "()"))
    ++n;
  std::string name = read_name(tokens, n);
  const bool is_definition = n == tokens.size() || tokens[n].text == "final" || tokens[n].text == ":";
  // Types within a specialisation, or without a name, are told apart by something else.
  if (!is_definition || name.empty()) return {};
  return {Scope::Kind::kType, std::move(name)};
}

std::optional<std::string> qualified_name(const std::vector<Scope>& scopes) {
  std::string name;
  for (const Scope& scope : scopes) {
    if (scope.kind == Scope::Kind::kOther) return std::nullopt;
    if (!scope.name.empty()) name += (name.empty() ? "" : "::") + scope.name;
  }
  return name;
}

}  // namespace

std::vector<TypeDefinition> find_type_definitions(std::string_view source) {
  std::vector<TypeDefinition> found;
  std::vector<Scope> scopes;
  Tokens statement;
  for (Token& token : Lexer(source).run()) {
    const bool is_end = token.text == "{" || token.text == "}" || token.text == ";";
    if (token.text == "{") {
      scopes.push_back(open_scope(statement));
      const std::optional<std::string> name = qualified_name(scopes);
      if (scopes.back().kind == Scope::Kind::kType && name) found.push_back({*name, token.line});
    } else if (token.text == "}" && !scopes.empty()) {
      scopes.pop_back();
    }
    if (is_end)
      statement.clear();
    else
      statement.push_back(std::move(token));
  }
  return found;
}

std::vector<std::string> find_repeated_types(const std::map<std::string, std::string>& sources) {
  std::map<std::string, std::vector<std::string>> places;
  for (const auto& [path, text] : sources)
    for (const TypeDefinition& type : find_type_definitions(text))
      places[type.name].push_back(path + ":" + std::to_string(type.line));
  std::vector<std::string> complaints;
  for (const auto& [name, where] : places) {
    if (where.size() < 2) continue;
    std::string line = name + " is defined at";
    for (const std::string& place : where) line += " " + place;
    complaints.push_back(std::move(line));
  }
  return complaints;
}

}  // namespace trocar::architecture
