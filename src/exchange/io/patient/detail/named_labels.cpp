#include "io/patient/detail/named_labels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>

#include "io/image/detail/payload.h"
#include "io/image/detail/read_grid.h"
#include "io/patient/detail/mask_folder.h"
#include "io/patient/detail/number_schemes.h"

namespace trocar::io::detail {
namespace {

/// Fewer numbers than a whole body has can as well be another program's: 1 = liver, 2 = tumour.
constexpr std::size_t kFewNumbers = 10;

using Names = std::vector<std::pair<int, std::string>>;

/// "1 = spleen, 5 = liver"
std::string readings_text(const Names& names) {
  std::vector<std::string> texts;
  for (const auto& [number, name] : names) texts.push_back(fmt::format("{} = {}", number, name));
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// A file with one value is a mask named after its file. A single file can also be a segmentation with one structure:
/// this holds if only the label map knows a name.
bool is_mask(const std::vector<int>& values, const std::string& stem, const LabelMap& map, Place place) {
  if (values.size() != 1) return values.empty();
  return place == Place::kInFolder || map.is_known(stem) || !map.has_number(values.front());
}

/// liver.nii with 1 and 2 is a liver with its tumour, or two parts of a liver, but no spleen and kidney. Allowed if the
/// user has named these numbers, or has chosen a scheme other than the one that is taken without a choice.
Status check_one_structure(const std::vector<int>& values, const std::string& stem, const std::string& where,
                           const LabelMap& map) {
  if (values.size() < 2 || !map.is_structure_file(stem)) return {};
  const bool is_named = std::ranges::all_of(values, [&](int value) { return map.is_own(value); });
  const bool is_chosen = !map.is_default() && !map.is_empty() &&
                         std::ranges::all_of(values, [&](int value) { return map.has_number(value); });
  if (is_named || is_chosen) return {};
  constexpr std::size_t kMostNamed = 5;
  const std::vector<int> first(values.begin(), values.begin() + static_cast<long>(std::min(values.size(), kMostNamed)));
  return fail(fmt::format("is named after one structure, \"{}\", but has {} label values ({}{})", stem, values.size(),
                          fmt::join(first, ", "), values.size() > kMostNamed ? " …" : ""),
              where,
              "give a mask of one value; or say what the numbers mean: --label-map lits (1 liver, 2 tumour; the user "
              "guide lists the others), or a TOML file with [labels]; or give a whole segmentation another name");
}

/// The value in all corners of the volume, if it is one.
std::optional<int> value_in_corners(const volume::LabelGrid& labels) {
  std::optional<int> value;
  const volume::Index3& size = labels.geometry.size;
  for (unsigned corner = 0; corner < 8; ++corner) {
    volume::Index3 ijk{};
    for (std::size_t axis = 0; axis < 3; ++axis) ijk[axis] = (corner >> axis & 1U) != 0 ? size[axis] - 1 : 0;
    const int here = labels.voxels[labels.geometry.offset(ijk)];
    if (value && *value != here) return std::nullopt;
    value = here;
  }
  return value;
}

/// What surrounds the structures must be 0 or have no name: numbers that were all raised by one, or an inverted mask,
/// make an organ of it.
Status check_background(const patient_builder::LabelSource& source, const LabelMap& map) {
  const auto& known = map.structures();
  const auto surrounds = [&](const std::string& name) {
    const anatomy::KnownStructure* structure = known.find(name);
    return name == patient_builder::kIgnoredStructure || known.is_background(name) || known.is_region(name) ||
           (structure != nullptr && structure->tissue == "skin");
  };
  const bool any_outside = std::ranges::find(source.labels.voxels, 0) != source.labels.voxels.end() ||
                           std::ranges::any_of(source.names, [&](const auto& n) { return surrounds(n.second); });
  if (!any_outside)
    return fail("has no background: no voxel is 0", source.file,
                "export the labels with 0 outside of the structures (check the header's scaling)");
  const auto outside = value_in_corners(source.labels);
  const auto named = std::ranges::find_if(source.names, [&](const auto& n) { return outside == n.first; });
  if (outside.value_or(0) == 0 || named == source.names.end()) return {};
  const anatomy::KnownStructure* structure = known.find(named->second);
  // The skin's mask and fat can fill a CT that is cropped within the body.
  if (structure == nullptr || structure->tissue == "skin" || structure->tissue == "adipose") return {};
  return fail(fmt::format("the background has the label {}, which is \"{}\"", *outside, named->second), source.file,
              "export the labels with 0 as the background (check the header's scaling), or ignore this label");
}

/// The names in the file's own header; none if it has no table for these values. What the user has written or chosen
/// wins; a chosen scheme that says something else than the table is told.
Result<Names> own_names(const RawVolume& raw, const std::vector<int>& values, const std::filesystem::path& path,
                        const LabelMap& map, std::vector<std::string>& warnings) {
  TROCAR_TRY(const auto table, read_label_table(raw.label_table, path.string()));
  Names names, others;
  for (const int value : values) {
    const auto in_table = table.find(value);
    const bool is_named = in_table != table.end() && !in_table->second.empty();
    const bool is_by_user = map.is_own(value) || (map.is_chosen() && map.has_number(value));
    if (is_by_user) names.emplace_back(value, *map.name_of(value));
    if (is_named && !is_by_user) names.emplace_back(value, map.name_of(in_table->second));
    if (is_named && is_by_user && !map.is_own(value) && in_table->second != names.back().second)
      others.emplace_back(value, in_table->second);
  }
  if (!others.empty())
    warnings.push_back(fmt::format("the header of {} names its labels otherwise ({}); the label map is used",
                                   path.filename().string(), readings_text(others)));
  return std::ranges::any_of(values, [&](int value) { return table.contains(value); }) ? names : Names{};
}

void tell_readings(const patient_builder::LabelSource& source, const std::vector<int>& values,
                   const std::filesystem::path& path, const LabelMap& map, Place place,
                   std::vector<std::string>& warnings) {
  const std::string file = path.filename().string();
  if (values.size() == 1 && place == Place::kNamedByUser)
    warnings.push_back(
        fmt::format("the only label of {}, {}, is \"{}\" by the label map: if this is wrong, name the file "
                    "after its structure",
                    file, values.front(), map.name_of(values.front()).value_or("")));
  if (values.size() > 1 && values.size() < kFewNumbers && map.is_default())
    warnings.push_back(
        fmt::format("the numbers of {} are read as TotalSegmentator's: {}; if this is wrong, name them by "
                    "--label-map",
                    file, readings_text(source.names)));
}

}  // namespace

Result<patient_builder::LabelSource> name_labels(const RawVolume& raw, const std::filesystem::path& path,
                                                 const LabelMap& map, Place place, std::vector<std::string>& warnings) {
  const std::string where = path.string();
  TROCAR_TRY(volume::LabelGrid labels, to_grid<std::uint8_t>(raw, where, convert_voxels));
  patient_builder::LabelSource source{where, std::move(labels), {}, false, {}, {}};
  const std::vector<int> values = values_in(source.labels);
  const std::string stem = map.name_in_file_name(image_stem(path));
  const bool is_named_mask = values.size() == 1 && map.is_known(map.name_of(stem));
  TROCAR_TRY(source.names, own_names(raw, values, path, map, warnings));
  if (is_named_mask && !source.names.empty() && source.names.front().second != map.name_of(stem))
    warnings.push_back(fmt::format("the header of {} names its label \"{}\"; the name of the file is used",
                                   path.filename().string(), source.names.front().second));
  if (!source.names.empty() && !is_named_mask) {
    TROCAR_TRY_STATUS(check_background(source, map));
    source.other_readings = map.other_readings(source.names);
    // The map that is taken without a choice does not win over the table.
    for (patient_builder::OtherReading& other : source.other_readings)
      if (other.advice.empty() && other.label_map == kTotalSegmentator)
        other.advice = fmt::format("give a TOML file with base = \"{}\" by --label-map", kTotalSegmentator);
    source.numbers_of = map.is_chosen() ? map.base_words() : "the label table in its header";
    return source;
  }
  if (is_mask(values, stem, map, place)) {
    source.names = {{values.empty() ? 1 : values.front(), map.name_of(stem)}};
    TROCAR_TRY_STATUS(check_background(source, map));
    return source;
  }
  TROCAR_TRY_STATUS(check_one_structure(values, stem, where, map));
  if (map.is_empty())
    return fail(fmt::format("has {} label values but no names for them", values.size()), where,
                "name them: --label-map totalsegmentator, or a TOML file with [labels] 1 = \"liver\" …");
  for (const int value : values)
    if (auto name = map.name_of(value)) source.names.emplace_back(value, std::move(*name));
  TROCAR_TRY_STATUS(check_background(source, map));
  tell_readings(source, values, path, map, place, warnings);
  // What a user has written is no likely mistake.
  if (map.base_words().empty() || std::ranges::all_of(values, [&](int value) { return map.is_own(value); }))
    return source;
  source.other_readings = map.other_readings(source.names);
  source.numbers_of = map.base_words();
  return source;
}

}  // namespace trocar::io::detail
