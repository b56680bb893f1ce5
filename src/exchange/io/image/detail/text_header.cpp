#include "io/image/detail/text_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "core/ascii.h"
#include "core/parse_number.h"
#include "io/image/detail/image_header.h"

namespace trocar::io::detail {
namespace {

constexpr std::size_t kMostLines = 10'000;  ///< A segmentation of 255 structures has about 3,000.
constexpr std::uint64_t kMostHeaderBytes = std::uint64_t{4} << 20;        ///< The libraries hold it several times.
constexpr std::size_t kLongestNrrdField = 500, kLongestPair = 64 * 1024;  // nine numbers of 24 letters fit
constexpr std::size_t kLongestMetaField = 250;                            ///< MetaIO keeps texts in arrays of 255.
constexpr std::size_t kLongestKey = 250;
constexpr std::string_view kLastMetaKey = "ElementDataFile";

/// The libraries and this program must read the same lines: no control characters, and no line of blanks, which ends
/// the header for some readers only.
bool is_plain_line(std::string_view line) {
  const bool has_control =
      std::any_of(line.begin(), line.end(), [](unsigned char c) { return (c < 0x20 && c != '\t') || c == 0x7f; });
  return !has_control && (line.empty() || !trim(line).empty());
}

/// One line without its end; false at the end of the file. Reads at most the longest line that is accepted, and one
/// character more.
bool read_line(std::ifstream& file, std::string& line, std::uint64_t& position) {
  line.clear();
  for (char c = 0; line.size() <= kLongestPair && file.get(c);) {
    ++position;
    if (c == '\n') {
      if (line.ends_with('\r')) line.pop_back();
      return true;
    }
    line.push_back(c);
  }
  return !line.empty();
}

struct Field {
  std::string key, value;
};

/// A NRRD line is a field ("space: …"), a pair ("key:=value"), a comment or the magic; only a field is returned.
std::optional<Field> nrrd_field(std::string_view line) {
  const std::size_t field = line.find(": "), pair = line.find(":=");
  if (line.starts_with('#') || field == std::string_view::npos || pair < field) {
    // "field:" without a value or a space.
    const bool is_bare = !line.starts_with('#') && pair == std::string_view::npos;
    const std::size_t colon = is_bare ? line.find(':') : std::string_view::npos;
    if (colon == std::string_view::npos) return std::nullopt;
    return Field{ascii::lower_case(trim(line.substr(0, colon))), trim(line.substr(colon + 1))};
  }
  return Field{ascii::lower_case(trim(line.substr(0, field))), trim(line.substr(field + 2))};
}

std::optional<Field> meta_field(std::string_view line) {
  const std::size_t at = line.find('=');
  if (at == std::string_view::npos) return std::nullopt;
  return Field{ascii::lower_case(trim(line.substr(0, at))), trim(line.substr(at + 1))};
}

class TextHeaderReader {
 public:
  TextHeaderReader(const InputFile& input, TextHeaderKind kind)
      : where_(input.path().string()), kind_(kind), file_(input.pinned_path(), std::ios::binary) {}

  Result<TextHeader> read() {
    std::string line;
    for (std::size_t number = 1; read_line(file_, line, header_.end); ++number) {
      TROCAR_TRY(const bool is_last, take(line, number));
      if (is_last) return std::move(header_);
    }
    if (kind_ == TextHeaderKind::kMeta) return damaged("the header has no line ElementDataFile");
    if (header_.fields.empty()) return damaged("the header has no field");
    return std::move(header_);
  }

 private:
  tl::unexpected<Error> damaged(const std::string& what) const { return fail(what, where_, kExportAgain); }

  /// True: the header ends with this line.
  Result<bool> take(const std::string& line, std::size_t number) {
    if (header_.end > kMostHeaderBytes)
      return damaged(fmt::format("the header has more than {} MiB", kMostHeaderBytes >> 20));
    if (number > kMostLines) return damaged(fmt::format("the header has more than {} lines", kMostLines));
    if (line.size() > kLongestPair)
      return damaged(fmt::format("line {} of the header is longer than {} characters", number, kLongestPair));
    if (!is_plain_line(line))
      return damaged(fmt::format("line {} of the header contains control characters or only blanks", number));
    if (line.empty()) return true;
    const bool is_nrrd = kind_ == TextHeaderKind::kNrrd;
    const auto field = is_nrrd ? nrrd_field(line) : meta_field(line);
    if (!field) {
      // A pair, a comment, or the magic; the library repeats any other line in its message.
      const bool is_other = is_nrrd && (number == 1 || line.starts_with('#') || line.find(":=") <= kLongestKey);
      if (!is_other) return damaged(fmt::format("line {} of the header is no field", number));
      const std::size_t pair = is_nrrd && !line.starts_with('#') ? line.find(":=") : std::string::npos;
      if (pair != std::string::npos && !pairs_.insert(trim(std::string_view(line).substr(0, pair))).second)
        return damaged(fmt::format("the header has the key \"{}\" twice", trim(line.substr(0, pair))));
      return false;
    }
    const std::size_t most = is_nrrd ? kLongestNrrdField : kLongestMetaField;
    if (line.size() > most || field->key.size() > kLongestKey)
      return damaged(fmt::format("line {} of the header is too long: a field of {} characters", number, line.size()));
    if (!header_.fields.emplace(field->key, field->value).second)
      return damaged(fmt::format("the header has the field \"{}\" twice", field->key));
    if (is_nrrd || field->key != ascii::lower_case(std::string(kLastMetaKey))) return false;
    // The library accepts this key in this spelling only, and would otherwise continue to read.
    if (!line.starts_with(kLastMetaKey)) return damaged("the header spells ElementDataFile in another way");
    return true;
  }

  std::string where_;
  TextHeaderKind kind_;
  std::ifstream file_;
  std::set<std::string> pairs_;  ///< Keys of NRRD's "key:=value".
  TextHeader header_;
};

template <class Number>
std::vector<Number> numbers_in(std::string_view text) {
  std::vector<Number> numbers;
  for (std::string_view rest = text; !rest.empty();) {
    if (ascii::is_space(rest.front())) {
      rest.remove_prefix(1);
      continue;
    }
    const auto number = find_leading_number<Number>(rest);
    if (!number || (!number->rest.empty() && !ascii::is_space(number->rest.front()))) return {};
    numbers.push_back(number->value);
    rest = number->rest;
  }
  return numbers;
}

}  // namespace

std::string TextHeader::get(const std::string& key, std::string fallback) const {
  const auto found = fields.find(key);
  return found == fields.end() ? fallback : found->second;
}

bool has_frame_transforms(const TextHeader& header) {
  return std::any_of(header.fields.begin(), header.fields.end(), [](const auto& field) {
    return field.first.starts_with("seq_frame") && field.first.ends_with("transform");
  });
}

Result<TextHeader> read_text_header(const InputFile& input, TextHeaderKind kind) {
  return TextHeaderReader(input, kind).read();
}

std::string trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1));
}

std::vector<std::int64_t> whole_numbers(std::string_view text) {
  return numbers_in<std::int64_t>(text);
}

std::vector<double> real_numbers(std::string_view text) {
  return numbers_in<double>(text);
}

}  // namespace trocar::io::detail
