#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace trocar::metrics::detail {

/// What the event field of a row says; the texts are parts of the field.
struct PoseEvents {
  bool is_paused = false;  ///< An interruption was before this row.
  std::vector<std::string_view> punctures;
  std::string fault;  ///< "'interruption:abc': the length is no number of seconds"; empty: none.
};

/// Reads "puncture:skin;interruption:0.5". Every event has to be one of those that `trocar session export` writes
/// (storage/session_file.h); a field without events is empty.
PoseEvents read_pose_events(std::string_view field);

/// Takes the first line off a text, without its end.
inline std::string_view take_line(std::string_view& text) noexcept {
  const std::size_t end = std::min(text.find('\n'), text.size());
  std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

inline std::string_view trimmed(std::string_view text) noexcept {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// The parts between separators; of an empty text one empty part.
inline std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  std::size_t begin = 0;
  for (std::size_t n = 0; n < text.size(); ++n) {
    if (text[n] != separator) continue;
    parts.push_back(text.substr(begin, n - begin));
    begin = n + 1;
  }
  parts.push_back(text.substr(begin));
  return parts;
}

/// The comma separated fields of a line, without spaces around them. A field in quotation marks may hold commas; its
/// doubled quotation marks stay doubled. Returns what is wrong with the last of `fields`, which ends the reading;
/// nullptr: nothing.
inline const char* split_fields(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (;;) {
    line = line.substr(std::min(line.find_first_not_of(" \t"), line.size()));
    std::size_t end = 0;
    if (line.starts_with('"')) {
      end = 1;
      while (end < line.size() && (line[end] != '"' || line.substr(end + 1).starts_with('"')))
        end += line[end] == '"' ? 2 : 1;
      fields.push_back(line.substr(1, std::min(end, line.size()) - 1));
      if (end >= line.size()) return "a quotation does not end";
      const std::size_t next = std::min(line.find(',', end), line.size());
      if (!trimmed(line.substr(end + 1, next - end - 1)).empty()) return "text after a quotation";
      end = next;
    } else {
      end = std::min(line.find(','), line.size());
      fields.push_back(trimmed(line.substr(0, end)));
      if (fields.back().find('"') != std::string_view::npos) return "a quotation mark inside of a field";
    }
    if (end == line.size()) return nullptr;
    line.remove_prefix(end + 1);
  }
}

}  // namespace trocar::metrics::detail
