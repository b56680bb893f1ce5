#include "io/patient/detail/patient_toml.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "config/toml.h"
#include "config/toml_writer.h"
#include "core/files/input_file.h"
#include "core/parallel.h"
#include "io/patient/patient_folder.h"

namespace trocar::io::detail {
namespace fs = std::filesystem;
namespace {

constexpr double kFarthest_mm = 1e5;

Result<anatomy::Label> label_of(const config::TomlTable& table) {
  TROCAR_TRY_STATUS(table.check_keys({"id", "name", "tissue", "color", "derived"}));
  anatomy::Label label;
  TROCAR_TRY(const std::int64_t id, table.integer("id", {1, 255}));
  label.id = static_cast<std::uint8_t>(id);
  TROCAR_TRY(label.name, table.string("name"));
  TROCAR_TRY(label.tissue, table.string("tissue"));
  TROCAR_TRY(const std::vector<double> color, table.numbers("color", {0, 255}));
  if (color.size() != 3) return fail("a colour is three numbers from 0 to 255", table.where(), "write [r, g, b]");
  for (std::size_t n = 0; n < 3; ++n) label.color[n] = static_cast<std::uint8_t>(color[n]);
  TROCAR_TRY(label.is_derived, table.boolean_or("derived", false));  // folders of format 1 lack it
  return label;
}

Result<anatomy::LabelTable> labels_of(const config::TomlTable& file) {
  anatomy::LabelTable table;
  std::set<std::string> names;
  TROCAR_TRY(const std::vector<config::TomlTable> rows, file.tables("labels"));
  for (const config::TomlTable& row : rows) {
    TROCAR_TRY(anatomy::Label label, label_of(row));
    if (!names.insert(label.name).second || table.find(label.id) != nullptr)
      return fail(fmt::format("label {} \"{}\" occurs twice", label.id, label.name), row.where(),
                  "ids and names must be unique");
    table.labels.push_back(std::move(label));
  }
  std::sort(table.labels.begin(), table.labels.end(),
            [](const anatomy::Label& a, const anatomy::Label& b) { return a.id < b.id; });
  return table;
}

Result<PatientMeshEntry> mesh_entry_of(const config::TomlTable& table) {
  TROCAR_TRY_STATUS(table.check_keys({"name", "file"}));
  PatientMeshEntry entry;
  TROCAR_TRY(entry.name, table.string("name"));
  TROCAR_TRY(entry.file, table.string("file"));
  const fs::path file(entry.file);
  if (file.parent_path() != "meshes" || file.filename() == "..")
    return fail("the surface does not lie in meshes/", table.where(), "build the patient again");
  return entry;
}

Result<anatomy::Finding> repair_of(const config::TomlTable& table) {
  TROCAR_TRY_STATUS(table.check_keys({"text", "label", "position"}));
  anatomy::Finding repair;
  TROCAR_TRY(repair.text, table.string("text"));
  TROCAR_TRY(repair.label, table.string_or("label", ""));
  if (!table.has("position")) return repair;
  TROCAR_TRY(const std::vector<double> p, table.numbers("position", {-kFarthest_mm, kFarthest_mm}));
  if (p.size() != 3) return fail("a position is three numbers in mm", table.where(), "write [x, y, z]");
  repair.place_P = Vec3(p[0], p[1], p[2]);
  return repair;
}

Status check_version(const config::TomlTable& file, const fs::path& path) {
  TROCAR_TRY(const std::int64_t version, file.integer("format_version", {1, 1e6}));
  if (version <= kPatientFormatVersion) return {};
  return fail(fmt::format("the patient has format {}, this program reads up to {}", version, kPatientFormatVersion),
              path.string(), "use a newer version of the program");
}

}  // namespace

std::string to_toml(const PatientDescription& patient) {
  config::TomlWriter writer;
  writer.comment("A virtual patient. ct.nrrd: HU; labels.nrrd: ids of [[labels]]; skin_distance.nrrd: hundredths");
  writer.comment("of a mm, negative inside the body. Frame P: LPS, mm.");
  writer.set("format_version", kPatientFormatVersion);
  writer.set("name", patient.name);
  writer.set("description", patient.description);
  writer.set("provenance", patient.provenance);
  writer.set("posture", std::string(anatomy::posture_name(patient.posture)));
  writer.set("content_hash", patient.content_hash);
  for (const anatomy::Label& label : patient.label_table.labels) {
    writer.begin_row("labels");
    writer.set("id", label.id);
    writer.set("name", label.name);
    writer.set("tissue", label.tissue);
    writer.set("color", std::vector<int>(label.color.begin(), label.color.end()));
    if (label.is_derived) writer.set("derived", true);
  }
  for (const PatientMeshEntry& mesh : patient.meshes) {
    writer.begin_row("meshes");
    writer.set("name", mesh.name);
    writer.set("file", mesh.file);
  }
  for (const anatomy::Finding& repair : patient.repairs) {
    writer.begin_row("repairs");
    writer.set("text", repair.text);
    if (!repair.label.empty()) writer.set("label", repair.label);
    if (const auto& p = repair.place_P) writer.set("position", std::vector<double>{p->x(), p->y(), p->z()});
  }
  return writer.text();
}

Result<PatientDescription> load_patient_toml(const fs::path& path, const fs::path& folder) {
  TROCAR_TRY(const std::string text, read_input(path, FileKind::kToml, folder));
  TROCAR_TRY(const config::TomlTable file, config::parse_toml(text, path.string()));
  TROCAR_TRY_STATUS(check_version(file, path));
  TROCAR_TRY_STATUS(file.check_keys({"format_version", "name", "description", "provenance", "posture", "content_hash",
                                     "labels", "meshes", "repairs"}));
  PatientDescription patient;
  TROCAR_TRY(patient.name, file.string("name"));
  TROCAR_TRY(patient.description, file.string_or("description", ""));
  TROCAR_TRY(patient.provenance, file.strings("provenance"));
  TROCAR_TRY(patient.content_hash, file.string("content_hash"));
  TROCAR_TRY(const std::string posture, file.string_or("posture", "supine"));
  const auto known_posture = anatomy::find_posture(posture);
  if (!known_posture)
    return fail("\"" + posture + "\" is no posture", path.string(),
                "write supine, prone, left-lateral, right-lateral or sitting");
  patient.posture = *known_posture;
  TROCAR_TRY(patient.label_table, labels_of(file));
  TROCAR_TRY(const std::vector<config::TomlTable> meshes, file.tables("meshes"));
  for (const config::TomlTable& mesh : meshes) {
    TROCAR_TRY(PatientMeshEntry entry, mesh_entry_of(mesh));
    patient.meshes.push_back(std::move(entry));
  }
  TROCAR_TRY(const std::vector<config::TomlTable> repairs, file.tables("repairs"));
  for (const config::TomlTable& row : repairs) {
    TROCAR_TRY(anatomy::Finding repair, repair_of(row));
    patient.repairs.push_back(std::move(repair));
  }
  return patient;
}

namespace {
namespace fs = std::filesystem;

constexpr float kDistanceUnit_mm = 0.01F;
constexpr std::size_t kDistancesAtOnce = std::size_t{1} << 18;

}  // namespace

Result<PatientDescription> load_description(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    return fail("no such patient folder", folder.string(), "build one with trocar patient build");
  if (!fs::exists(folder / kDescriptionFile, error))
    return fail("not a patient folder: it has no patient.toml", folder.string(), "build one with trocar patient build");
  return load_patient_toml(folder / kDescriptionFile, folder);
}

volume::CtGrid to_hundredths(const volume::FloatGrid& distance_mm) {
  volume::CtGrid hundredths;
  hundredths.geometry = distance_mm.geometry;
  hundredths.voxels.resize(distance_mm.voxels.size());
  parallel_for(distance_mm.voxels.size(), kDistancesAtOnce, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      hundredths.voxels[n] = static_cast<std::int16_t>(
          std::lround(std::clamp(distance_mm.voxels[n] / kDistanceUnit_mm, -32767.0F, 32767.0F)));
  });
  return hundredths;
}

volume::FloatGrid from_hundredths(const volume::CtGrid& hundredths) {
  volume::FloatGrid distance_mm;
  distance_mm.geometry = hundredths.geometry;
  distance_mm.voxels.resize(hundredths.voxels.size());
  parallel_for(hundredths.voxels.size(), kDistancesAtOnce, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      distance_mm.voxels[n] = kDistanceUnit_mm * static_cast<float>(hundredths.voxels[n]);
  });
  return distance_mm;
}

Status check_label_ids(const anatomy::VirtualPatient& patient, const std::string& where) {
  std::array<bool, 256> occurs{};
  for (const std::uint8_t id : patient.labels.voxels) occurs[id] = true;
  for (std::size_t id = 1; id < occurs.size(); ++id)
    if (occurs[id] && patient.label_table.find(static_cast<std::uint8_t>(id)) == nullptr)
      return fail(fmt::format("the label volume has the value {}, which is not in the label table", id), where,
                  kBuildAgain);
  return {};
}

Status check_geometry(const anatomy::VirtualPatient& patient, const std::string& where) {
  const volume::GridGeometry& g = patient.ct.geometry;
  if (g.matches(patient.labels.geometry) && g.matches(patient.skin_distance_mm.geometry)) return {};
  return fail("CT, labels and skin distance are not on the same grid", where, kBuildAgain);
}

}  // namespace trocar::io::detail
