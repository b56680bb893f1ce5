#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "cases/force_curve.h"
#include "cases/neutral_start.h"
#include "cases/prepare_case.h"
#include "core/background_job.h"
#include "geometry/pose.h"
#include "ultrasound/doppler/flow_on_demand.h"
#include "ultrasound/probe/transducer.h"
#include "ultrasound/tissue/acoustic_scene.h"

namespace trocar::cases {

/// What a trainee chooses on the start page.
struct CaseChoice {
  CaseOptions options;
  std::string patient_source = "abdomen";  ///< A patient folder, or an embedded patient's name.
  std::uint64_t patient_seed = 1;          ///< Of an embedded patient.
  std::string force_model;                 ///< insertion | proxy | combined; empty: the task's.
};
bool operator==(const CaseChoice& a, const CaseChoice& b);

/// A case with all that is shown of it. Immutable, shared by all views. Frame P.
struct OpenCase {
  CaseChoice choice;
  Case the_case;
  std::string force_model;  ///< The choice's, else the task's.
  /// How a haptic server of this machine opens the patient: the choice's source, or the folder where it is kept.
  std::string server_source;
  std::shared_ptr<const std::vector<anatomy::NamedMesh>> meshes;
  std::shared_ptr<const ultrasound::AcousticScene> acoustic;
  std::shared_ptr<ultrasound::FlowOnDemand> flow;  ///< Notes say if no vessel of this patient has flow.
  ultrasound::Transducer transducer;
  double probe_depth_mm = 160.0;  ///< Depth of picture that shows the target and what lies behind it.
  /// Where the transducer begins: pressed lightly onto the skin, with the planned path in its plane and the face beside
  /// the entry; where that cannot be, a standard view (is_in_plane says which).
  Pose X_PT_start;
  bool is_in_plane = false;
  NeutralStart neutral;               ///< Where the tools begin when nothing of the plan may be told.
  std::vector<PathPiece> pieces;      ///< Tissue along the planned path.
  std::vector<CurvePoint> predicted;  ///< Force along it at 10 mm/s, without the stylus' weight.
  std::vector<std::string> notes;     ///< What is missing or doubtful, a line each.
  double seconds = 0.0;               ///< That opening took.
};

struct OpenOptions {
  /// Lends patient, surfaces and acoustic scene where they are the same.
  std::shared_ptr<const OpenCase> previous;
  /// Embedded patients are kept there (PatientCache), so that they and the servers' scenes open in a second or two the
  /// next time; empty: they are made anew each time, half a minute of computing. `io::patient_cache_folder()` is the
  /// place.
  std::filesystem::path cache_folder;
};

/// Opens a case; what is slow runs side by side. `stop` is looked at between the parts. Errors: the patient, the
/// tables, no path for this task (with what is in the way).
Result<std::shared_ptr<const OpenCase>> make_open_case(const CaseChoice& choice, const OpenOptions& options = {},
                                                       const Progress& progress = {}, const std::stop_token& stop = {});
/// The same in the background.
BackgroundJob<std::shared_ptr<const OpenCase>> open_case(CaseChoice choice, OpenOptions options);
BackgroundJob<std::shared_ptr<const OpenCase>> open_case(CaseChoice choice,
                                                         std::shared_ptr<const OpenCase> previous = nullptr);

/// Force along a case's planned path with other tissue numbers ("liver.k=0.5") and force model (empty: the case's):
/// what a trainee would feel at 10 mm/s. Errors: an unknown name, a number out of range (exit status 2).
Result<std::vector<CurvePoint>> predict_force(const Case& the_case, const std::vector<std::string>& overrides,
                                              const std::string& force_model);
BackgroundJob<std::vector<CurvePoint>> predict_force_in_background(std::shared_ptr<const OpenCase> open_case,
                                                                   std::vector<std::string> overrides,
                                                                   std::string force_model = {});

}  // namespace trocar::cases
