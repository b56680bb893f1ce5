#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "image/image.h"

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

/// File in the data folder.
inline constexpr std::string_view kStructuresFile = "structures.toml";

/// A structure that is known by its name.
struct KnownStructure {
  std::string tissue;  ///< Tissue class (TissueTable). "skin": a mask of the whole body, no structure inside it.
  image::Rgb color{};
  int priority = 0;  ///< Where masks overlap, the higher one gets the voxel (a tumour over its liver).
};

/// The structure names of data/structures.toml: TotalSegmentator v2, 3D-IRCADb, the embedded patients, the tissues
/// found from HU; and the label numbers of data/totalsegmentator.toml. Loaded once for an operation (a build, a
/// phantom) and passed on; immutable afterwards, and safe to read from several threads.
class KnownStructures {
 public:
  /// Reads the two files of a data folder. Errors name file and line: a missing file, an unknown key, colour or
  /// priority, a name that cannot match or occurs twice, label numbers that do not count from 1.
  static Result<KnownStructures> load(const std::filesystem::path& data_folder);

  /// Ignores case, separators, side and a number. nullptr: an unknown name. Valid as long as this object.
  const KnownStructure* find(std::string_view name) const;

  /// Names of background labels ("background", "air", "Clear Label"), independent of case and separators.
  bool is_background(std::string_view name) const;

  /// Names of regions that hold several structures, but are none ("abdominal_cavity"), independent of case and
  /// separators.
  bool is_region(std::string_view name) const;

  /// The known names most similar to an unknown one, best first; only those within a few letters of it (edit distance
  /// at most a quarter of the longer name).
  std::vector<std::string> similar_names(std::string_view name, std::size_t count = 3) const;

  /// TotalSegmentator v2, task "total": the names of the label numbers, 1 first.
  const std::vector<std::string>& totalsegmentator_names() const noexcept { return totalsegmentator_; }

  /// structures.toml, for messages.
  const std::string& file() const noexcept { return file_; }

 private:
  friend class StructureReader;
  struct Row {
    StructurePattern pattern;
    bool needs_side;        ///< Only a name with "left" or "right".
    std::size_t structure;  ///< Index into structures_.
  };
  std::string file_;
  std::vector<KnownStructure> structures_;
  std::vector<Row> rows_;  ///< The first matching row is used.
  std::vector<std::string> background_;
  std::vector<std::string> regions_;
  std::vector<std::string> totalsegmentator_;
};

}  // namespace trocar::anatomy
