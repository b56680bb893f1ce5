#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/action.h"
#include "cli/output.h"
#include "io/patient/patient_cache.h"
#include "motion/patient_motion.h"
#include "ultrasound/doppler/vessel_flow.h"
#include "ultrasound/engine/b_mode.h"
#include "ultrasound/probe/probe_view.h"
#include "ultrasound/scanner/display_settings.h"

namespace trocar::cli {

/// Arguments of all commands that scan a patient; defaults come from the transducer or the view.
struct ScanArguments {
  io::PatientSource source;
  std::string pose, view, save_pose;
  std::string transducer;
  std::optional<double> depth_mm, frequency_mhz, focus_mm;
  std::optional<bool> is_harmonic;  ///< Empty: as saved with the pose, otherwise off.
  std::optional<int> lines, samples, planes, steering_angles;
  ultrasound::DisplaySettings display;
  std::vector<double> tgc_db;
  std::string gray_map;
  std::vector<std::string> off;
  std::uint64_t seed = 1;  ///< Seed of the receiver's noise.
  bool needs_flow = false;
  std::string breathing;  ///< As the next one for cases::breathing_of().
  std::optional<double> phase;
};

/// Adds the options; `arguments` must outlive the command.
void add_scan_options(Command& command, ScanArguments& arguments);

/// Arguments that were combined and checked against their ranges, and the acoustic scene of the patient.
struct Scan {
  ultrasound::Transducer transducer;
  ultrasound::Acquisition acquisition;
  ultrasound::DisplaySettings display;
  std::optional<ultrasound::ProbeView> view;
  Pose X_PT;
  std::optional<ultrasound::ViewVisibility> visibility;  ///< Visibility of the view's subject.
  double unscanned_share = 0.0;                          ///< Share of the image beyond the ends of the CT.
  std::string patient_name;
  std::shared_ptr<const motion::MotionModel> motion;  ///< Of the patient; null: it does not move.
  motion::MotionDrive breathing;
  std::shared_ptr<const ultrasound::AcousticScene> scene;
  std::shared_ptr<const ultrasound::VesselFlow> flow;  ///< Null unless needs_flow.
};

/// Errors of the arguments are returned before the patient is opened. `default_transducer` is used if neither the
/// arguments nor the view name a transducer.
Result<Scan> prepare_scan(const ScanArguments& arguments, const std::string& default_transducer,
                          const Progress& progress);

/// Where the patient of a scan is at a time.
inline motion::PatientMotion motion_at(const Scan& scan, double time_s) noexcept {
  return motion::MotionClock{scan.motion.get(), scan.breathing}.at(time_s);
}

/// Checks that outputs can be written: they do not exist, their folders exist, and all are different. Empty ones are
/// ignored.
Status check_outputs(const std::vector<std::string>& outputs);

/// Warns if the transducer face has no or only partial contact. `coupled`: the share of scanlines on the skin, 0..1.
void warn_of_contact(double coupled);

/// Warns if the view shows little of its subject, and if the image extends beyond the CT.
void warn_of_visibility(const Scan& scan);

/// Writes X_PT with the settings that --pose reads.
Status save_pose(const Scan& scan, const std::string& path);

config::Json to_json(const Pose& X);
config::Json to_json(const Scan& scan);

}  // namespace trocar::cli
