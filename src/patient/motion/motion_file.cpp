#include "motion/motion_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "config/toml.h"
#include "config/toml_writer.h"
#include "core/content_hash.h"

namespace trocar::motion {
namespace {

using config::Range;
using config::TomlTable;

constexpr int kFormat = 2;
constexpr std::int64_t kAxes = 3;

}  // namespace

std::string to_toml(const MotionModel& model) {
  const MotionParts& parts = model.parts();
  config::TomlWriter writer;
  writer.comment("How the patient moves against the CT. Displacements (mm, LPS) and border: motion_*.nrrd.");
  writer.set("format", kFormat);
  writer.set("source", parts.source);
  writer.set("drivers", parts.drivers);
  writer.set("regions", parts.regions);
  writer.comment("How far the liver moves down (mm) where the drivers are 1.");
  writer.set("liver_mm", parts.liver_mm);
  writer.comment("Values of the drivers when the CT was taken; 0: at end-expiration.");
  writer.set("at_ct", std::vector<double>(parts.at_ct.begin(),
                                          parts.at_ct.begin() + static_cast<std::ptrdiff_t>(parts.drivers.size())));
  writer.comment("Of all three files.");
  writer.set("hash", model.hash());
  return writer.text();
}

Result<MotionDescription> parse_motion(std::string_view text, const std::string& name) {
  TROCAR_TRY(const TomlTable table, config::parse_toml(text, name));
  TROCAR_TRY(const std::int64_t format, table.integer("format", Range{1.0, 1e6}));
  if (format != kFormat)
    return fail(fmt::format("was written by {} version (format {})", format > kFormat ? "a newer" : "an older", format),
                name,
                format > kFormat ? "install the newer version" : "make it again: trocar patient motion DIR --force");
  TROCAR_TRY_STATUS(table.check_keys({"format", "source", "drivers", "regions", "liver_mm", "at_ct", "hash"}));
  MotionDescription description;
  MotionParts& parts = description.parts;
  TROCAR_TRY(description.hash, table.string("hash"));
  TROCAR_TRY(parts.source, table.string("source"));
  TROCAR_TRY(parts.drivers, table.strings("drivers"));
  TROCAR_TRY(parts.regions, table.strings("regions"));
  TROCAR_TRY(parts.liver_mm, table.number("liver_mm", Range{1.0, 100.0}));
  TROCAR_TRY(const std::vector<double> at_ct, table.numbers("at_ct", Range{kLeastDrive, kMostDrive}));
  if (at_ct.size() != parts.drivers.size() || at_ct.size() > kMostDrivers)
    return fail(fmt::format("at_ct needs one number for each driver, at most {}", kMostDrivers), name, "correct it");
  std::ranges::copy(at_ct, parts.at_ct.begin());
  return description;
}

volume::FloatGrid stack_modes(const MotionParts& parts) {
  volume::GridGeometry geometry = parts.lattice;
  geometry.size[2] *= kAxes * static_cast<std::int64_t>(parts.modes.size());
  volume::FloatGrid stack(geometry);
  const std::size_t nodes = parts.lattice.voxel_count();
  for (std::size_t mode = 0; mode < parts.modes.size(); ++mode)
    for (std::size_t axis = 0; axis < kAxes; ++axis)
      for (std::size_t n = 0; n < nodes; ++n)
        stack.voxels[(mode * kAxes + axis) * nodes + n] = parts.modes[mode][n][static_cast<Eigen::Index>(axis)];
  return stack;
}

Status unstack_modes(const volume::FloatGrid& stack, MotionParts& parts, const std::string& name) {
  const auto modes = static_cast<std::int64_t>(parts.drivers.size() * parts.regions.size());
  parts.lattice = stack.geometry;
  if (modes == 0 || parts.lattice.size[2] % (kAxes * modes) != 0)
    return fail(fmt::format("does not have the displacements of {} modes", modes), name,
                "make the model again: trocar patient motion DIR --force");
  parts.lattice.size[2] /= kAxes * modes;
  const std::size_t nodes = parts.lattice.voxel_count();
  parts.modes.assign(static_cast<std::size_t>(modes), std::vector<Vec3f>(nodes));
  for (std::size_t mode = 0; mode < parts.modes.size(); ++mode)
    for (std::size_t axis = 0; axis < kAxes; ++axis)
      for (std::size_t n = 0; n < nodes; ++n)
        parts.modes[mode][n][static_cast<Eigen::Index>(axis)] = stack.voxels[(mode * kAxes + axis) * nodes + n];
  return {};
}

std::string hash_motion(const MotionParts& parts) {
  ContentHash hash;
  const auto add = [&](const auto& values) { hash.add(std::as_bytes(std::span(values))); };
  const auto add_text = [&](const std::string& text) {
    add(std::array{static_cast<std::uint64_t>(text.size())});
    add(text);
  };
  const auto add_geometry = [&](const volume::GridGeometry& geometry) {
    add(geometry.size);
    // Plus 0: files do not keep the sign of a zero.
    for (const Vec3& v : {geometry.spacing_mm, geometry.origin_P})
      add(std::array{v.x() + 0.0, v.y() + 0.0, v.z() + 0.0});
    for (const double number : geometry.R_PV.reshaped()) add(std::array{number + 0.0});
  };
  for (const auto& names : {parts.drivers, parts.regions}) {
    add(std::array{static_cast<std::uint64_t>(names.size())});
    for (const std::string& name : names) add_text(name);
  }
  add_geometry(parts.lattice);
  for (const std::vector<Vec3f>& mode : parts.modes)
    if (!mode.empty()) add(std::span(mode.front().data(), 3 * mode.size()));
  add_geometry(parts.border_mm.geometry);
  add(parts.border_mm.voxels);
  add(std::array{parts.liver_mm});
  add(parts.at_ct);
  return hash.digest();
}

}  // namespace trocar::motion
