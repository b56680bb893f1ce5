// trocar patient export: CT and structures of a patient for other programs.
#include <fmt/format.h>

#include <filesystem>

#include "cli/commands.h"
#include "cli/output.h"
#include "cli/patient_option.h"
#include "core/progress.h"
#include "io/patient/build_from_files.h"
#include "io/patient/patient_cache.h"

namespace trocar::cli {
namespace {

struct ExportArguments {
  io::PatientSource source;
  bool is_nifti = false, is_dicom = false;
  std::string out;
};

Status run_export(const ExportArguments& arguments) {
  if (arguments.is_nifti == arguments.is_dicom)
    return fail_usage("name one format", "patient export", "write --nifti or --dicom");
  TROCAR_TRY_STATUS(check_new(arguments.out));
  const ProgressPrinter printer;
  const Progress progress = printer.callback();
  TROCAR_TRY(const anatomy::VirtualPatient patient, io::open_patient(arguments.source, part_of(progress, 0.0, 0.5)));
  return io::export_patient(patient, arguments.is_nifti ? io::ExportKind::kNifti : io::ExportKind::kDicom,
                            arguments.out, part_of(progress, 0.5, 1.0));
}

}  // namespace

void add_patient_export_command(Command& patient, Action& action) {
  Command command = patient.add_command("export", "Write CT and structures of a patient as NIfTI or DICOM");
  command.footer(
      "NIfTI: ct.nii.gz and one mask a structure in segmentations/. DICOM: ct/ and segmentation.dcm, body.dcm (SEG).\n"
      "What a build derives itself is left out.\n\nExample:\n"
      "  trocar patient export abdomen --nifti --out abdomen_files\n"
      "  trocar patient build --ct abdomen_files/ct.nii.gz --labels abdomen_files/segmentations --out again\n");
  const auto a = std::make_shared<ExportArguments>();
  command.add_option("PATIENT", a->source.folder_or_name, "Patient folder, or an embedded patient's name").required();
  command.add_option("--seed", a->source.seed, "Seed of an embedded patient").seed().show_default();
  command.add_flag("--nifti", a->is_nifti, "Write NIfTI");
  command.add_flag("--dicom", a->is_dicom, "Write DICOM: CT Image and Segmentation");
  command.add_option("--out", a->out, "Folder to create").required();
  add_cache_option(command, a->source);
  command.when_parsed([&action, a] { action = [a] { return run_export(*a); }; });
}

}  // namespace trocar::cli
