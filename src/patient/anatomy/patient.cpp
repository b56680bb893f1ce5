#include "anatomy/patient.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "core/content_hash.h"
#include "volume/sampling.h"

namespace trocar::anatomy {
namespace {

template <class Values>
void add_values(ContentHash& hash, const Values& values) {
  hash.add(std::as_bytes(std::span(values)));
}
template <class T>
void add_value(ContentHash& hash, const T& value) {
  hash.add(std::as_bytes(std::span(&value, 1)));
}

/// Preceded by its length, so that adjacent fields cannot be confused.
void add_text(ContentHash& hash, const std::string& text) {
  add_value(hash, static_cast<std::uint64_t>(text.size()));
  add_values(hash, text);
}

/// In single precision and with normalised zeros: rounding in a file must not change the hash.
void add_geometry(ContentHash& hash, const volume::GridGeometry& geometry) {
  add_values(hash, geometry.size);
  const auto add_number = [&](double value) {
    add_value(hash, std::abs(value) < 1e-6 ? 0.0F : static_cast<float>(value));
  };
  for (int a = 0; a < 3; ++a) add_number(geometry.spacing_mm[a]);
  for (int a = 0; a < 3; ++a) add_number(geometry.origin_P[a]);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) add_number(geometry.R_PV(row, column));
  }
}

}  // namespace

std::string hash_patient(const VirtualPatient& patient) {
  ContentHash hash;
  add_geometry(hash, patient.ct.geometry);
  add_values(hash, patient.ct.voxels);
  add_geometry(hash, patient.labels.geometry);
  add_values(hash, patient.labels.voxels);
  for (const Label& label : patient.label_table.labels) {
    add_value(hash, label.id);
    add_text(hash, label.name);
    add_text(hash, label.tissue);
    add_values(hash, label.color);
  }
  return hash.digest();
}

const Label* find_label(const VirtualPatient& patient, const Vec3& p_A) noexcept {
  const std::uint8_t id = volume::sample_nearest<std::uint8_t>(patient.labels, p_A, 0);
  return id == 0 ? nullptr : patient.label_table.find(id);
}

const Label* LabelTable::find(std::uint8_t id) const noexcept {
  const auto it = std::lower_bound(labels.begin(), labels.end(), id,
                                   [](const Label& label, std::uint8_t wanted) { return label.id < wanted; });
  return it != labels.end() && it->id == id ? &*it : nullptr;
}

const Label* LabelTable::find(std::string_view name) const noexcept {
  const auto it = std::find_if(labels.begin(), labels.end(), [&](const Label& label) { return label.name == name; });
  return it != labels.end() ? &*it : nullptr;
}

std::array<std::uint8_t, 256> lesions_as_organs(const LabelTable& table) noexcept {
  constexpr std::string_view kLesion = "_lesion";
  std::array<std::uint8_t, 256> organ_of{};
  for (std::size_t id = 0; id < organ_of.size(); ++id) organ_of[id] = static_cast<std::uint8_t>(id);
  for (const Label& label : table.labels) {
    const std::string_view tissue = label.tissue;
    if (!tissue.ends_with(kLesion)) continue;
    const std::string_view around = tissue.substr(0, tissue.size() - kLesion.size());
    const auto organ = std::find_if(table.labels.begin(), table.labels.end(),
                                    [&](const Label& other) { return other.tissue == around; });
    organ_of[label.id] = organ != table.labels.end() ? organ->id : std::uint8_t{0};
  }
  return organ_of;
}

namespace {

struct PostureRow {
  std::string_view name, words;
  std::array<double, 3> down_P;
};

constexpr std::array<PostureRow, 5> kRows{{{"supine", "lying on the back", {0, 1, 0}},
                                           {"prone", "lying on the belly", {0, -1, 0}},
                                           {"left-lateral", "lying on the left side", {1, 0, 0}},
                                           {"right-lateral", "lying on the right side", {-1, 0, 0}},
                                           {"sitting", "sitting", {0, 0, -1}}}};

const PostureRow& row_of(Posture posture) {
  return kRows[static_cast<std::size_t>(posture)];
}

}  // namespace

std::string_view posture_name(Posture posture) {
  return row_of(posture).name;
}

std::string_view posture_words(Posture posture) {
  return row_of(posture).words;
}

std::optional<Posture> find_posture(std::string_view name) {
  for (std::size_t n = 0; n < kRows.size(); ++n)
    if (kRows[n].name == name) return static_cast<Posture>(n);
  return std::nullopt;
}

Vec3 gravity_P(Posture posture) {
  const auto& down = row_of(posture).down_P;
  return {down[0], down[1], down[2]};
}

}  // namespace trocar::anatomy
