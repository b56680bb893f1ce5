// trocar patient motion: the breathing model of a patient.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "anatomy/label_statistics.h"
#include "anatomy/patient.h"
#include "cli/commands.h"
#include "cli/output.h"
#include "config/json.h"
#include "io/patient/motion_files.h"
#include "io/patient/patient_folder.h"
#include "motion_builder/breathing_model.h"
#include "png/png_file.h"
#include "slices/motion_sheet.h"

namespace trocar::cli {
namespace {
namespace fs = std::filesystem;
using motion::kDeepLiver_mm, motion::kQuietLiver_mm, motion_builder::StructureMotion;

struct MotionArguments {
  io::PatientSource source;
  std::string show;
  double ct_inhaled_mm = 0.0;
  bool is_ct_given = false;
  bool is_forced = false;
  bool is_json = false;
};

/// A breath in which the liver moves down by so much: both drivers in proportion.
motion::MotionModel::Scalars breath(const motion::MotionModel& model, double liver_mm) {
  motion::MotionModel::Scalars drivers{};
  for (std::size_t d = 0; d < model.parts().drivers.size(); ++d) drivers[d] = liver_mm / model.parts().liver_mm;
  return drivers;
}

Vec3 in_breath(const StructureMotion& structure, const motion::MotionModel::Scalars& drivers) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t d = 0; d < structure.by_driver_mm.size(); ++d) sum += drivers[d] * structure.by_driver_mm[d];
  return sum;
}

/// Makes the model of a patient that has none, or another one on request; a folder gets it.
Status bring_up_to_date(const MotionArguments& arguments, anatomy::VirtualPatient& patient) {
  const bool is_folder = io::is_path(arguments.source.folder_or_name);
  if (patient.motion != nullptr && !arguments.is_forced && !arguments.is_ct_given) return {};
  if (patient.motion != nullptr && is_folder && !arguments.is_forced)
    return fail_usage("the patient has a breathing model, and sessions with it could not be replayed with another one",
                      arguments.source.folder_or_name, "add --force to make it again");
  const ProgressPrinter printer;
  TROCAR_TRY(patient.motion,
             motion_builder::make_breathing_model(patient, {arguments.ct_inhaled_mm}, printer.callback()));
  if (!is_folder) return {};
  return io::save_motion_model(*patient.motion, arguments.source.folder_or_name);
}

/// The middle of the liver, or of the volume.
Vec3 middle_of(const anatomy::VirtualPatient& patient) {
  const anatomy::Label* const liver = patient.label_table.find("liver");
  for (const anatomy::LabelStatistics& row : anatomy::label_statistics(patient))
    if (liver != nullptr && row.id == liver->id && row.voxels > 0) return row.centroid_P;
  const volume::GridGeometry& grid = patient.labels.geometry;
  return grid.to_mm(0.5 * volume::to_vec3(grid.size));
}

Status draw(const anatomy::VirtualPatient& patient, const fs::path& file) {
  slices::MotionSheet sheet;
  sheet.to = breath(*patient.motion, kDeepLiver_mm);
  sheet.middle_A = middle_of(patient);
  return png::write_png(slices::paint_motion(patient, *patient.motion, sheet), file);
}

config::Json to_json(const anatomy::VirtualPatient& patient, const std::vector<StructureMotion>& structures) {
  const motion::MotionModel& model = *patient.motion;
  config::Json rows = config::Json::array();
  for (const StructureMotion& structure : structures) {
    const Vec3 quiet = in_breath(structure, breath(model, kQuietLiver_mm));
    const Vec3 deep = in_breath(structure, breath(model, kDeepLiver_mm));
    rows.push_back({{"name", structure.name},
                    {"quiet_mm", {quiet.x(), quiet.y(), quiet.z()}},
                    {"deep_mm", {deep.x(), deep.y(), deep.z()}}});
  }
  return {{"patient", patient.name},
          {"hash", model.hash()},
          {"source", model.parts().source},
          {"ct_inhaled_mm", model.parts().at_ct[0] * model.parts().liver_mm},
          {"most_liver_mm", motion::kMostDrive * model.parts().liver_mm},
          {"structures", rows}};
}

void print(const anatomy::VirtualPatient& patient, const std::vector<StructureMotion>& structures) {
  const motion::MotionModel& model = *patient.motion;
  const double ct_mm = model.parts().at_ct[0] * model.parts().liver_mm;
  fmt::print("breathing model of {}: {}\n", patient.name, model.parts().source);
  if (ct_mm == 0.0)
    fmt::print("the CT shows end-expiration (assumed, unless --ct-inhaled says otherwise)\n");
  else
    fmt::print("the CT shows the liver {:.1f} mm below its place at end-expiration\n", ct_mm);
  fmt::print("mean motion from end-expiration to end-inspiration, mm (quiet: liver {:.0f} mm down; deep: {:.1f} mm)\n",
             kQuietLiver_mm, kDeepLiver_mm);
  fmt::print("{:<28} {:>10} {:>10} {:>12}\n", "structure", "quiet down", "deep down", "deep forward");
  for (const StructureMotion& structure : structures) {
    const Vec3 quiet = in_breath(structure, breath(model, kQuietLiver_mm));
    const Vec3 deep = in_breath(structure, breath(model, kDeepLiver_mm));
    fmt::print("{:<28} {:>10.1f} {:>10.1f} {:>12.1f}\n", structure.name, -quiet.z(), -deep.z(), -deep.y());
  }
}

/// Before any work: the name of a new PNG in a folder that exists.
Status check_picture(const fs::path& file) {
  if (file.empty()) return {};
  if (file.extension() != ".png")
    return fail_usage("the picture is a PNG", file.string(), "give a name that ends in .png");
  std::error_code ignored;
  if (file.has_parent_path() && !fs::is_directory(file.parent_path(), ignored))
    return fail_usage("the folder does not exist", file.parent_path().string(), "create it first");
  return check_new(file, "--show");
}

Status show_motion(const MotionArguments& arguments) {
  TROCAR_TRY_STATUS(check_picture(arguments.show));
  const bool is_made_again = arguments.is_forced && io::is_path(arguments.source.folder_or_name);
  TROCAR_TRY(anatomy::VirtualPatient patient,
             is_made_again ? io::load_anatomy(arguments.source.folder_or_name) : io::load_source(arguments.source));
  TROCAR_TRY_STATUS(bring_up_to_date(arguments, patient));
  const auto structures = motion_builder::structure_motions(patient, *patient.motion);
  if (arguments.is_json)
    print_json(to_json(patient, structures));
  else
    print(patient, structures);
  return arguments.show.empty() ? Status() : draw(patient, arguments.show);
}

}  // namespace

void add_patient_motion_command(Command& patient, Action& action) {
  Command command =
      patient.add_command("motion", "Show the breathing model of a patient; make it where a patient folder has none");
  command.footer(
      "Examples:\n  trocar patient motion abdomen --show breathing.png\n"
      "  trocar patient motion case_1 --ct-inhaled 12 --force\n");
  const auto a = std::make_shared<MotionArguments>();
  command.add_option("DIR", a->source.folder_or_name, "Patient folder, or an embedded patient's name").required();
  command.add_option("--patient-seed", a->source.seed, "Random seed for the anatomy of an embedded patient")
      .seed()
      .show_default();
  command.add_option("--show", a->show,
                     "PNG to write: coronal and sagittal slices at both ends of a deep breath, and the motion between");
  command
      .add_option("--ct-inhaled", a->ct_inhaled_mm,
                  "How far the liver was below its place at end-expiration when the CT was taken; without it 0")
      .number_within(-20.0, 40.0, "mm");
  command.add_flag("--force", a->is_forced,
                   "Make the model of a folder again; sessions with the old one are lost for replay");
  command.add_flag("--json", a->is_json, "Print one JSON object");
  command.when_parsed([&action, a] {
    a->is_ct_given = a->ct_inhaled_mm != 0.0;
    action = [a] { return show_motion(*a); };
  });
}

}  // namespace trocar::cli
