#include "xray/geometry/c_arm.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "config/toml.h"

namespace trocar::xray {
namespace {

constexpr double kBehindIsocentre_mm = 50.0;  ///< Least distance of the detector behind the isocentre.

struct Limit {
  const char* name;
  double value, low, high;
};

/// Axes of the image in P.
struct ImageAxes {
  Vec3 right, up;
};

ImageAxes image_axes(const CArm& arm) noexcept {
  const double sin_lao = std::sin(arm.lao_deg * kRadPerDeg), cos_lao = std::cos(arm.lao_deg * kRadPerDeg);
  const double sin_cranial = std::sin(arm.cranial_deg * kRadPerDeg),
               cos_cranial = std::cos(arm.cranial_deg * kRadPerDeg);
  return {{cos_lao, sin_lao, 0.0}, {-sin_cranial * sin_lao, sin_cranial * cos_lao, cos_cranial}};
}

}  // namespace

Status check_c_arm(const CArm& arm) {
  const Limit limits[] = {
      {"lao_deg", arm.lao_deg, -180.0, 180.0},
      {"cranial_deg", arm.cranial_deg, -90.0, 90.0},
      {"source_isocentre_mm", arm.source_isocentre_mm, 300.0, 1500.0},
      {"source_detector_mm", arm.source_detector_mm, 400.0, 2000.0},
      {"field_mm", arm.field_mm, 50.0, 500.0},
      {"pixels", static_cast<double>(arm.pixels), 16.0, 2048.0},
      {"collimation of the columns", arm.collimation[0], 0.05, 1.0},
      {"collimation of the rows", arm.collimation[1], 0.05, 1.0},
  };
  for (const Limit& limit : limits)
    if (!(limit.value >= limit.low && limit.value <= limit.high))
      return fail_usage(fmt::format("the C-arm's {} is {:g}", limit.name, limit.value), "C-arm",
                        fmt::format("give a value from {:g} to {:g}", limit.low, limit.high));
  if (!arm.isocentre_P.allFinite())
    return fail_usage("the C-arm's isocentre is not finite", "C-arm", "give three finite numbers in mm");
  if (!(arm.source_detector_mm > arm.source_isocentre_mm + kBehindIsocentre_mm))
    return fail_usage(
        fmt::format("the detector, {:g} mm from the source, is not behind the isocentre at {:g} mm",
                    arm.source_detector_mm, arm.source_isocentre_mm),
        "C-arm", fmt::format("give a source_detector_mm above {:g}", arm.source_isocentre_mm + kBehindIsocentre_mm));
  return {};
}

Vec3 towards_detector_P(const CArm& arm) noexcept {
  const double lao = arm.lao_deg * kRadPerDeg, cranial = arm.cranial_deg * kRadPerDeg;
  return {std::sin(lao) * std::cos(cranial), -std::cos(lao) * std::cos(cranial), std::sin(cranial)};
}

double magnification(const CArm& arm) noexcept {
  return arm.source_detector_mm / arm.source_isocentre_mm;
}

XrayRays rays_of(const CArm& arm) noexcept {
  const Vec3 towards = towards_detector_P(arm);
  const ImageAxes axes = image_axes(arm);
  const double pixel_mm = arm.field_mm / arm.pixels;
  const double first = 0.5 * (arm.pixels - 1);
  XrayRays rays;
  rays.source_P = arm.isocentre_P - arm.source_isocentre_mm * towards;
  rays.column_P = pixel_mm * axes.right;
  rays.row_P = -pixel_mm * axes.up;
  rays.first_pixel_P = rays.source_P + arm.source_detector_mm * towards - first * rays.column_P - first * rays.row_P;
  rays.columns = rays.rows = arm.pixels;
  return rays;
}

std::array<double, 2> XrayRays::project(const Vec3& p_P) const noexcept {
  const Vec3 normal = column_P.cross(row_P);
  const Vec3 from_source = p_P - source_P;
  const double distance = normal.dot(first_pixel_P - source_P), depth = normal.dot(from_source);
  // Both have one sign for a point on the detector's side of the source.
  if (!(depth * distance > 0.0)) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    return {kNone, kNone};
  }
  const Vec3 on_detector = source_P + (distance / depth) * from_source - first_pixel_P;
  return {on_detector.dot(column_P) / column_P.squaredNorm(), on_detector.dot(row_P) / row_P.squaredNorm()};
}

namespace {

struct Field {
  std::string_view key;
  double* value;
  config::Range range;
};

Result<CArmPreset> read_preset(const std::string& name, const config::TomlTable& row) {
  CArmPreset preset;
  preset.name = name;
  TROCAR_TRY(preset.title, row.string("title"));
  const Field fields[] = {
      {"source_isocentre_mm", &preset.arm.source_isocentre_mm, {300.0, 1500.0}},
      {"source_detector_mm", &preset.arm.source_detector_mm, {400.0, 2000.0}},
      {"detector_mm", &preset.detector_mm, {0.1, 2.0}},
      {"aluminium_mm", &preset.aluminium_mm, {0.5, 20.0}},
      {"copper_mm", &preset.copper_mm, {0.0, 1.0}},
      {"kv", &preset.kv, {40.0, 150.0}},
      {"lao_deg", &preset.largest_lao_deg, {0.0, 180.0}},
      {"cranial_deg", &preset.largest_cranial_deg, {0.0, 90.0}},
  };
  std::vector<std::string_view> known{"title", "fields_mm", "fields_source", "pixels"};
  for (const Field& field : fields) {
    TROCAR_TRY(const config::SourcedNumber number, config::read_sourced_number(row, field.key, field.range));
    *field.value = number.value;
    known.push_back(field.key);
  }
  TROCAR_TRY_STATUS(row.check_keys(known));
  TROCAR_TRY_STATUS(row.string("fields_source"));
  TROCAR_TRY(preset.fields_mm, row.numbers("fields_mm", {50.0, 500.0}));
  if (preset.fields_mm.empty() || !std::is_sorted(preset.fields_mm.rbegin(), preset.fields_mm.rend()))
    return fail("the fields of a C-arm do not fall", row.where(), "list fields_mm from the largest to the smallest");
  TROCAR_TRY(const std::int64_t pixels, row.integer("pixels", {16.0, 2048.0}));
  preset.arm.pixels = static_cast<int>(pixels);
  preset.arm.field_mm = preset.fields_mm.front();
  if (const Status status = check_c_arm(preset.arm); !status)
    return fail(status.error().what, row.where(), status.error().advice);
  return preset;
}

}  // namespace

Result<std::vector<CArmPreset>> load_c_arms(const std::filesystem::path& file) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(file));
  TROCAR_TRY_STATUS(document.check_keys({"carms"}));
  TROCAR_TRY(const config::TomlTable rows, document.table("carms"));
  std::vector<CArmPreset> presets;
  for (const std::string& name : rows.keys()) {
    TROCAR_TRY(const config::TomlTable row, rows.table(name));
    TROCAR_TRY(CArmPreset preset, read_preset(name, row));
    presets.push_back(std::move(preset));
  }
  if (presets.empty()) return fail("the file lists no C-arm", file.string(), "add a table [carms.NAME]");
  return presets;
}

Result<CArmPreset> load_c_arm(const std::filesystem::path& file, std::string_view name) {
  TROCAR_TRY(const std::vector<CArmPreset> presets, load_c_arms(file));
  const auto found = std::ranges::find(presets, name, &CArmPreset::name);
  if (found != presets.end()) return *found;
  std::vector<std::string> names;
  for (const CArmPreset& preset : presets) names.push_back(preset.name);
  return fail_usage(fmt::format("there is no C-arm \"{}\"", name), file.string(),
                    fmt::format("known are: {}", fmt::join(names, ", ")));
}

}  // namespace trocar::xray
