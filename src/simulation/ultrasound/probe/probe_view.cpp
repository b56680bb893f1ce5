#include "ultrasound/probe/probe_view.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "config/toml.h"
#include "ultrasound/probe/detail/view_anatomy.h"
#include "ultrasound/probe/detail/view_rays.h"

namespace trocar::ultrasound {
namespace {

constexpr std::size_t kLeastVoxels = 8;  // smaller labels are segmentation noise

/// Reads one of a few words.
template <class T, std::size_t N>
Status read_word_meaning(const config::TomlTable& row, std::string_view key,
                         const std::pair<std::string_view, T> (&words)[N], T& value) {
  if (!row.has(key)) return {};
  TROCAR_TRY(const std::string word, row.string(key));
  std::vector<std::string_view> known;
  for (const auto& [name, meaning] : words) {
    if (word == name) {
      value = meaning;
      return {};
    }
    known.push_back(name);
  }
  return fail(fmt::format("{} is \"{}\"", key, word), row.where(), fmt::format("use {}", fmt::join(known, ", ")));
}

Result<Vec3> read_vector(const config::TomlTable& row, std::string_view key, config::Range range,
                         const Vec3& fallback) {
  if (!row.has(key)) return fallback;
  TROCAR_TRY(const std::vector<double> numbers, row.numbers(key, range));
  if (numbers.size() != 3) return fail(fmt::format("{} has {} numbers", key, numbers.size()), row.where(), "give 3");
  return Vec3(numbers[0], numbers[1], numbers[2]);
}

Status read_choices(const config::TomlTable& row, ProbeView& view) {
  constexpr std::pair<std::string_view, ScanPlane> kPlanes[] = {{"longitudinal", ScanPlane::kLongitudinal},
                                                                {"transverse", ScanPlane::kTransverse}};
  constexpr std::pair<std::string_view, BonePreference> kBones[] = {
      {"avoid", BonePreference::kAvoid}, {"beside", BonePreference::kBeside}, {"show", BonePreference::kShow}};
  constexpr std::pair<std::string_view, TargetPoint> kPoints[] = {{"middle", TargetPoint::kMiddle},
                                                                  {"facing", TargetPoint::kFacing}};
  TROCAR_TRY_STATUS(read_word_meaning(row, "plane", kPlanes, view.plane));
  TROCAR_TRY_STATUS(read_word_meaning(row, "bone", kBones, view.bone));
  return read_word_meaning(row, "point", kPoints, view.point);
}

Result<ProbeView> read_view(const config::TomlTable& row, const std::string& name) {
  TROCAR_TRY_STATUS(
      row.check_keys({"title", "targets", "through", "point", "offset_mm", "direction", "plane", "angle_deg", "bone",
                      "pressed_mm", "search_mm", "depth_mm", "frequency_mhz", "focus_mm", "transducer"}));
  ProbeView view;
  view.name = name;
  TROCAR_TRY(view.title, row.string("title"));
  TROCAR_TRY(view.targets, row.strings("targets"));
  TROCAR_TRY(view.through, row.strings("through"));
  if (view.targets.empty()) return fail("the view has no targets", row.where(), "name at least one label");
  TROCAR_TRY_STATUS(read_choices(row, view));
  if (view.point == TargetPoint::kFacing && view.through.empty())
    return fail("point = \"facing\" needs what it faces", row.where(), "name labels in through");
  TROCAR_TRY(view.offset_mm, read_vector(row, "offset_mm", {-200.0, 200.0}, view.offset_mm));
  TROCAR_TRY(const Vec3 direction, read_vector(row, "direction", {-1.0, 1.0}, view.direction_P));
  if (direction.norm() < 0.1) return fail("direction has no length", row.where(), "give a direction that is not zero");
  view.direction_P = direction.normalized();
  TROCAR_TRY(const double angle_deg, row.number_or("angle_deg", {-180.0, 180.0}, 0.0));
  view.angle_rad = radians(angle_deg);
  TROCAR_TRY(view.pressed_mm, row.number_or("pressed_mm", {0.0, 15.0}, view.pressed_mm));
  TROCAR_TRY(view.search_mm, row.number_or("search_mm", {0.0, 60.0}, view.search_mm));
  if (row.has("frequency_mhz")) {
    TROCAR_TRY(view.frequency_mhz, row.number("frequency_mhz", {1.0, 20.0}));
  }
  if (row.has("focus_mm")) {
    TROCAR_TRY(view.focus_mm, row.number("focus_mm", {5.0, 300.0}));
  }
  TROCAR_TRY(view.depth_mm, row.number_or("depth_mm", {20.0, 300.0}, view.depth_mm));
  TROCAR_TRY(view.transducer, row.string("transducer"));
  return view;
}

std::array<std::size_t, 256> count_voxels(const volume::LabelGrid& labels) {
  std::array<std::size_t, 256> counts{};
  for (const std::uint8_t id : labels.voxels) ++counts[id];
  return counts;
}

const anatomy::Label* find_counted(const anatomy::LabelTable& table, const std::array<std::size_t, 256>& voxels,
                                   std::span<const std::string> patterns) {
  for (const std::string& pattern : patterns) {
    const std::string key = detail::plain_name(pattern);
    const anatomy::Label* largest = nullptr;
    for (const anatomy::Label& label : table.labels) {
      if (voxels[label.id] < kLeastVoxels || !detail::matches_pattern(key, detail::plain_name(label.name))) continue;
      if (largest == nullptr || voxels[label.id] > voxels[largest->id]) largest = &label;
    }
    if (largest != nullptr) return largest;
  }
  return nullptr;
}

/// The patterns that the patient needs one of but lacks; nullptr: none is missing.
const std::vector<std::string>* find_missing(const anatomy::LabelTable& table,
                                             const std::array<std::size_t, 256>& voxels, const ProbeView& view) {
  if (find_counted(table, voxels, view.targets) == nullptr) return &view.targets;
  const bool needs_through = view.point == TargetPoint::kFacing;
  return needs_through && find_counted(table, voxels, view.through) == nullptr ? &view.through : nullptr;
}

std::string missing_text(const ProbeView& view, const std::vector<std::string>& missing) {
  return fmt::format("view \"{}\" needs a label \"{}\", which this patient lacks", view.name,
                     fmt::join(missing, "\" or \""));
}

}  // namespace

Result<std::vector<ProbeView>> load_probe_views(const std::filesystem::path& path) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(path));
  TROCAR_TRY_STATUS(document.check_keys({"views"}));
  TROCAR_TRY(const config::TomlTable rows, document.table("views"));
  std::vector<ProbeView> views;
  for (const std::string& name : rows.keys()) {
    TROCAR_TRY(const config::TomlTable row, rows.table(name));
    TROCAR_TRY(ProbeView view, read_view(row, name));
    views.push_back(std::move(view));
  }
  return views;
}

const anatomy::Label* find_target(const anatomy::VirtualPatient& patient, std::span<const std::string> patterns) {
  return find_counted(patient.label_table, count_voxels(patient.labels), patterns);
}

std::string missing_label(const anatomy::VirtualPatient& patient, const ProbeView& view) {
  const auto* missing = find_missing(patient.label_table, count_voxels(patient.labels), view);
  return missing == nullptr ? std::string() : fmt::format("no label {}", fmt::join(*missing, ", "));
}

Status check_view(const anatomy::VirtualPatient& patient, const ProbeView& view) {
  const auto* missing = find_missing(patient.label_table, count_voxels(patient.labels), view);
  if (missing == nullptr) return {};
  return fail_usage(missing_text(view, *missing), patient.name, "choose another view");
}

std::vector<std::string> possible_views(const anatomy::VirtualPatient& patient, std::span<const ProbeView> views) {
  const auto voxels = count_voxels(patient.labels);
  std::vector<std::string> names;
  for (const ProbeView& view : views) {
    if (find_missing(patient.label_table, voxels, view) == nullptr) names.push_back(view.name);
  }
  return names;
}

Result<ProbeView> choose_view(const anatomy::VirtualPatient& patient, std::span<const ProbeView> views,
                              std::string_view name) {
  const auto it = std::find_if(views.begin(), views.end(), [&](const ProbeView& view) { return view.name == name; });
  if (it == views.end()) {
    std::vector<std::string_view> names;
    for (const ProbeView& view : views) names.push_back(view.name);
    return fail_usage(fmt::format("there is no view \"{}\"", name), {},
                      fmt::format("known are: {}", fmt::join(names, ", ")));
  }
  const auto* missing = find_missing(patient.label_table, count_voxels(patient.labels), *it);
  if (missing == nullptr) return *it;
  const std::vector<std::string> possible = possible_views(patient, views);
  return fail_usage(missing_text(*it, *missing), patient.name,
                    possible.empty() ? "no standard view fits this patient: give --pose FILE.tfm"
                                     : fmt::format("available views: {}", fmt::join(possible, ", ")));
}

Result<ViewVisibility> measure_visibility(const anatomy::VirtualPatient& patient, const ProbeView& view,
                                          const Transducer& transducer, const Pose& X_PT) {
  TROCAR_TRY(const Vec3 target_P, detail::find_target_point(patient, view));
  const detail::ViewAnatomy ground(patient, view);
  return detail::ViewRays(ground, view, transducer, target_P).measure(X_PT);
}

std::string hidden_causes(const ViewVisibility& visibility) {
  constexpr double kLeast = 0.005;
  std::vector<std::pair<double, const char*>> causes = {{visibility.behind_bone, "behind bone"},
                                                        {visibility.behind_gas, "behind gas or lung"},
                                                        {visibility.unscanned, "outside the CT"},
                                                        {visibility.outside_picture, "outside the picture"},
                                                        {visibility.too_deep, "too deep for the frequency"}};
  std::stable_sort(causes.begin(), causes.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::string> texts;
  for (const auto& [share, text] : causes)
    if (share >= kLeast) texts.push_back(fmt::format("{:.0f} % {}", 100.0 * share, text));
  return fmt::format("{}", fmt::join(texts, ", "));
}

}  // namespace trocar::ultrasound
