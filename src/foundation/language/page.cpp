#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "language/language.h"

namespace trocar::language {
namespace {

constexpr std::array kEntities = {std::pair("&lt;", '<'), std::pair("&gt;", '>'), std::pair("&quot;", '"'),
                                  std::pair("&#39;", '\''), std::pair("&amp;", '&')};

/// Attributes that people read or hear.
constexpr std::array kTextAttributes = {" title=\"", " alt=\"", " aria-label=\""};

/// Around names that people gave, which stay as they are even where a language has a word for them.
constexpr std::pair kKept("<span translate=\"no\"", "</span>");

constexpr std::string_view kEnglishRoot = "<html lang=\"en\"";

std::string unescaped(std::string_view html) {
  std::string text;
  for (std::size_t n = 0; n < html.size();) {
    std::size_t length = 0;
    for (const auto& [entity, letter] : kEntities) {
      if (!html.substr(n).starts_with(entity)) continue;
      text += letter;
      length = std::string_view(entity).size();
    }
    if (length == 0) text += html[n];
    n += length == 0 ? 1 : length;
  }
  return text;
}

std::string escaped(std::string_view text) {
  std::string html;
  for (const char letter : text) {
    std::string_view entity;
    for (const auto& [name, of] : kEntities)
      if (of == letter) entity = name;
    if (entity.empty())
      html += letter;
    else
      html += entity;
  }
  return html;
}

/// What becomes of a text of the page; the same text if it stays.
using Change = std::function<std::string(const std::string&)>;

/// A text that stays keeps its spelling.
std::string changed(const Change& change, std::string_view html) {
  const std::string text = unescaped(html);
  const std::string other = change(text);
  return other == text ? std::string(html) : escaped(other);
}

/// `<tag …>` with its attributes changed.
std::string changed_tag(const Change& change, std::string_view tag) {
  std::string result(tag);
  for (const std::string_view attribute : kTextAttributes) {
    const std::size_t at = result.find(attribute);
    if (at == std::string::npos) continue;
    const std::size_t from = at + attribute.size();
    const std::size_t end = result.find('"', from);
    if (end != std::string::npos) result.replace(from, end - from, changed(change, result.substr(from, end - from)));
  }
  return result;
}

/// Where the text begins that follows the tag: behind the whole element for code.
std::size_t end_of_tag(std::string_view html, std::size_t from) {
  for (const auto& [begin, end] :
       {std::pair("<script", "</script>"), std::pair("<style", "</style>"), std::pair("<pre", "</pre>"), kKept})
    if (html.substr(from).starts_with(begin))
      if (const std::size_t at = html.find(end, from); at != std::string_view::npos)
        return at + std::string_view(end).size();
  const std::size_t end = html.find('>', from);
  return end == std::string_view::npos ? html.size() : end + 1;
}

bool is_code(std::string_view tag) {
  return tag.starts_with("<script") || tag.starts_with("<style") || tag.starts_with("<pre") ||
         tag.starts_with(kKept.first);
}

std::string changed_page(const Change& change, std::string_view html) {
  std::string page;
  for (std::size_t from = 0; from < html.size();) {
    const bool is_tag = html[from] == '<';
    const std::size_t end = is_tag ? end_of_tag(html, from) : std::min(html.find('<', from), html.size());
    const std::string_view piece = html.substr(from, end - from);
    if (!is_tag)
      page += changed(change, piece);
    else
      page += is_code(piece) ? std::string(piece) : changed_tag(change, piece);
    from = end;
  }
  return page;
}

}  // namespace

std::string translate_page(const Language& language, std::string_view html) {
  if (language.is_english()) return std::string(html);
  std::string page = changed_page([&](const std::string& text) { return language.translate(text); }, html);
  if (const std::size_t at = page.find(kEnglishRoot); at != std::string::npos)
    page.replace(at, kEnglishRoot.size(), "<html lang=\"" + language.code() + "\"");
  return page;
}

std::vector<std::string> texts_of_page(std::string_view html) {
  std::vector<std::string> texts;
  changed_page(
      [&](const std::string& text) {
        texts.push_back(text);
        return text;
      },
      html);
  return texts;
}

}  // namespace trocar::language
