#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace trocar::anatomy {

/// Lower case letters and digits only.
std::string plain_name(std::string_view name);
/// A plain name without "left" and "right".
std::string without_side(std::string plain);

/// A name pattern of structures.toml. Its end can be '#', any number of digits; '%#', the letter of a spine region and
/// any number of digits; '*', anything.
class StructurePattern {
 public:
  /// Empty for a text that no name can match: an empty one, other characters, a side in it.
  static std::optional<StructurePattern> parse(std::string_view text);

  /// True if the pattern matches a plain name without side.
  bool matches(std::string_view key) const;
  const std::string& stem() const noexcept { return stem_; }  ///< Without the end, as plain_name.
  bool has_region() const noexcept { return end_ == "%#"; }
  bool operator==(const StructurePattern&) const = default;

 private:
  std::string stem_;
  std::string end_;  ///< "", "#", "%#" or "*".
};

}  // namespace trocar::anatomy
