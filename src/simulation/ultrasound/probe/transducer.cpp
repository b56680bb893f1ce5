#include "ultrasound/probe/transducer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "config/toml.h"

namespace trocar::ultrasound {
namespace {

constexpr std::pair<std::string_view, TransducerKind> kKinds[] = {
    {"convex", TransducerKind::kConvex},
    {"linear", TransducerKind::kLinear},
    {"phased", TransducerKind::kPhased},
    {"mechanical_convex", TransducerKind::kMechanicalConvex},
};

/// Reads sourced numbers of a row and records their keys, so that any other key is an error.
class Reader {
 public:
  explicit Reader(const config::TomlTable& row) : row_(row) {}

  Status value(std::string_view key, config::Range range, double& value) {
    known_.push_back(key);
    TROCAR_TRY(const config::SourcedNumber number, config::read_sourced_number(row_, key, range));
    value = number.value;
    return {};
  }
  Status angle(std::string_view key_deg, config::Range range_deg, double& value_rad) {
    double value_deg = 0.0;
    TROCAR_TRY_STATUS(value(key_deg, range_deg, value_deg));
    value_rad = value_deg * kRadPerDeg;
    return {};
  }
  Status count(std::string_view key, config::Range range, int& count) {
    double number = 0.0;
    TROCAR_TRY_STATUS(value(key, range, number));
    count = static_cast<int>(number);
    if (static_cast<double>(count) == number) return {};
    return fail(fmt::format("{} is {}, must be a whole number", key, number), row_.where(),
                "correct it in the transducer table");
  }
  Status finish() { return row_.check_keys(known_); }

 private:
  const config::TomlTable& row_;
  std::vector<std::string_view> known_{"description", "kind", "pressure_mpa", "power_mw"};  // see AcousticOutput
};

Result<TransducerKind> read_kind(const config::TomlTable& row) {
  TROCAR_TRY(const std::string word, row.string("kind"));
  std::vector<std::string_view> words;
  for (const auto& [known, kind] : kKinds) {
    if (word == known) return kind;
    words.push_back(known);
  }
  return fail(fmt::format("there is no kind \"{}\"", word), row.where(),
              fmt::format("known are: {}", fmt::join(words, ", ")));
}

Status read_pulse(Reader& reader, Transducer& t) {
  TROCAR_TRY_STATUS(reader.value("lowest_mhz", {0.5, 30.0}, t.lowest_mhz));
  TROCAR_TRY_STATUS(reader.value("highest_mhz", {t.lowest_mhz, 30.0}, t.highest_mhz));
  TROCAR_TRY_STATUS(reader.value("frequency_mhz", {t.lowest_mhz, t.highest_mhz}, t.frequency_mhz));
  return reader.value("bandwidth", {0.2, 1.2}, t.bandwidth);
}

Status read_array(Reader& reader, Transducer& t) {
  const bool has_arc = t.kind == TransducerKind::kConvex || t.kind == TransducerKind::kMechanicalConvex;
  TROCAR_TRY_STATUS(reader.count("elements", {16.0, 1024.0}, t.elements));
  TROCAR_TRY_STATUS(reader.count("active_elements", {8.0, static_cast<double>(t.elements)}, t.active_elements));
  TROCAR_TRY_STATUS(reader.value("pitch_mm", {0.05, 2.0}, t.pitch_mm));
  TROCAR_TRY_STATUS(reader.value("elevation_aperture_mm", {1.0, 30.0}, t.elevation_aperture_mm));
  TROCAR_TRY_STATUS(reader.value("elevation_focus_mm", {5.0, 200.0}, t.elevation_focus_mm));
  t.radius_mm = 0.0;
  if (has_arc) TROCAR_TRY_STATUS(reader.value("radius_mm", {5.0, 150.0}, t.radius_mm));
  t.field_of_view_rad = 0.0;
  if (t.kind == TransducerKind::kLinear) return {};
  return reader.angle("field_of_view_deg", {10.0, 170.0}, t.field_of_view_rad);
}

Status read_picture(Reader& reader, Transducer& t) {
  TROCAR_TRY_STATUS(reader.value("f_number", {0.5, 10.0}, t.f_number));
  TROCAR_TRY_STATUS(reader.value("greatest_depth_mm", {20.0, 400.0}, t.greatest_depth_mm));
  TROCAR_TRY_STATUS(reader.value("depth_mm", {10.0, t.greatest_depth_mm}, t.depth_mm));
  TROCAR_TRY_STATUS(reader.value("focus_mm", {5.0, t.greatest_depth_mm}, t.focus_mm));
  return reader.count("scanlines", {2.0, 1024.0}, t.scanlines);
}

Result<Transducer> read_transducer(const config::TomlTable& row, const std::string& name) {
  Transducer t;
  t.name = name;
  TROCAR_TRY(t.description, row.string("description"));
  TROCAR_TRY(t.kind, read_kind(row));
  Reader reader(row);
  TROCAR_TRY_STATUS(read_pulse(reader, t));
  TROCAR_TRY_STATUS(read_array(reader, t));
  TROCAR_TRY_STATUS(read_picture(reader, t));
  if (t.kind == TransducerKind::kMechanicalConvex) {
    TROCAR_TRY_STATUS(reader.angle("sweep_deg", {1.0, 180.0}, t.sweep_rad));
    TROCAR_TRY_STATUS(reader.value("sweep_radius_mm", {0.0, 150.0}, t.sweep_radius_mm));
  }
  TROCAR_TRY_STATUS(reader.finish());
  return t;
}

}  // namespace

Result<std::vector<Transducer>> load_transducers(const std::filesystem::path& path) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(path));
  TROCAR_TRY_STATUS(document.check_keys({"transducers"}));
  TROCAR_TRY(const config::TomlTable rows, document.table("transducers"));
  std::vector<Transducer> transducers;
  for (const std::string& name : rows.keys()) {
    TROCAR_TRY(const config::TomlTable row, rows.table(name));
    TROCAR_TRY(Transducer transducer, read_transducer(row, name));
    transducers.push_back(std::move(transducer));
  }
  return transducers;
}

Result<Transducer> load_transducer(const std::filesystem::path& path, std::string_view name) {
  TROCAR_TRY(std::vector<Transducer> transducers, load_transducers(path));
  const auto it =
      std::find_if(transducers.begin(), transducers.end(), [&](const Transducer& t) { return t.name == name; });
  if (it != transducers.end()) return std::move(*it);
  std::vector<std::string_view> names;
  for (const Transducer& transducer : transducers) names.push_back(transducer.name);
  return fail_usage(fmt::format("there is no transducer \"{}\"", name), path.string(),
                    fmt::format("known are: {}", fmt::join(names, ", ")));
}

AcousticIndices acoustic_indices(const AcousticOutput& output, double frequency_mhz, double focus_mm) noexcept {
  constexpr double kCmPerMm = 0.1;
  const double loss_db = kDerating_db_per_cm_mhz * frequency_mhz * focus_mm * kCmPerMm;
  const double pressure_mpa = output.pressure_mpa * std::pow(10.0, -loss_db / 20.0);
  AcousticIndices indices{pressure_mpa / std::sqrt(frequency_mhz),
                          output.power_mw * frequency_mhz / kThermalPower_mw_mhz};
  if (indices.mechanical > kMostMechanicalIndex) {
    const double lowered = kMostMechanicalIndex / indices.mechanical;
    indices.mechanical = kMostMechanicalIndex;
    indices.thermal *= lowered * lowered;
  }
  return indices;
}

Result<AcousticOutput> load_acoustic_output(const std::filesystem::path& path, std::string_view transducer) {
  // Checks the whole table, and reports an unknown name with the known ones.
  TROCAR_TRY_STATUS(load_transducer(path, transducer));
  TROCAR_TRY(const config::TomlTable document, config::load_toml(path));
  TROCAR_TRY(const config::TomlTable rows, document.table("transducers"));
  TROCAR_TRY(const config::TomlTable row, rows.table(std::string(transducer)));
  TROCAR_TRY(const config::SourcedNumber pressure, config::read_sourced_number(row, "pressure_mpa", {0.1, 10.0}));
  TROCAR_TRY(const config::SourcedNumber power, config::read_sourced_number(row, "power_mw", {0.1, 1000.0}));
  return AcousticOutput{pressure.value, power.value};
}

}  // namespace trocar::ultrasound
