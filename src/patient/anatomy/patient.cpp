#include "anatomy/patient.h"

#include <cmath>
#include <cstdint>
#include <span>

#include "core/hash.h"
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

const Label* find_label(const VirtualPatient& patient, const Vec3& p_P) noexcept {
  const std::uint8_t id = volume::sample_nearest<std::uint8_t>(patient.labels, p_P, 0);
  return id == 0 ? nullptr : patient.label_table.find(id);
}

}  // namespace trocar::anatomy
