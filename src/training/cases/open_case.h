#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/patient.h"
#include "cases/force_curve.h"
#include "cases/later_data.h"
#include "cases/neutral_start.h"
#include "cases/prepare_case.h"
#include "core/background_job.h"
#include "geometry/pose.h"
#include "io/patient/patient_folder.h"
#include "metrics/metric.h"
#include "ultrasound/doppler/flow_on_demand.h"
#include "ultrasound/panorama/panorama.h"
#include "ultrasound/probe/transducer.h"

namespace trocar::cases {

/// One part of opening a case and its duration. Parts run in parallel: the durations do not add up to the whole.
struct OpenPart {
  std::string name;  ///< "patient", "acoustic scene".
  double seconds = 0.0;
};

/// Measures the parts. Any thread may measure.
class OpenParts {
 public:
  /// Calls `work` and notes its duration; returns its result.
  template <class Work>
  auto measure(std::string_view name, const Work& work) {
    const auto begin = std::chrono::steady_clock::now();
    auto result = work();
    add(name, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    return result;
  }
  std::vector<OpenPart> take() {
    const std::lock_guard lock(mutex_);
    return std::move(parts_);
  }

 private:
  void add(std::string_view name, double seconds) {
    const std::lock_guard lock(mutex_);
    parts_.push_back({std::string(name), seconds});
  }
  std::mutex mutex_;
  std::vector<OpenPart> parts_;
};

/// Choice of a trainee on the start page.
struct CaseChoice {
  CaseOptions options;
  std::string patient_source = "abdomen";  ///< A patient folder, or an embedded patient's name.
  std::uint64_t patient_seed = 1;          ///< Seed of an embedded patient.
  std::string force_model;                 ///< insertion | proxy | combined; empty: the task's.
};
bool operator==(const CaseChoice& a, const CaseChoice& b);

/// A case with its displayed data. Immutable but for `later`, shared by all views. Frame P.
struct OpenCase {
  CaseChoice choice;
  Case the_case;
  std::string force_model;  ///< Force model of the choice, otherwise of the task.
  /// Source from which a haptic server of this machine opens the patient: the choice's source, or the folder where it
  /// is kept.
  std::string server_source;
  std::shared_ptr<LaterData> later;                ///< Acoustic scene and surfaces, which a thread still prepares.
  std::shared_ptr<ultrasound::FlowOnDemand> flow;  ///< `notes` reports it if no vessel of this patient has flow.
  /// nullptr: the patient has no panorama. The task says if the case begins with it.
  std::shared_ptr<ultrasound::PanoramaOnDemand> panorama;
  ultrasound::Transducer transducer;
  double probe_depth_mm = 160.0;  ///< Image depth that includes the target and the tissue behind it.
  /// Start pose of the transducer: pressed lightly onto the skin, with the planned path in its plane and the face
  /// beside the entry. If this is not possible: a standard view (is_in_plane is false).
  Pose X_PT_start;
  bool is_in_plane = false;
  NeutralStart neutral;               ///< Start poses of the tools that do not reveal the plan.
  std::vector<PathPiece> pieces;      ///< Tissue along the planned path.
  std::vector<CurvePoint> predicted;  ///< Force along it at 10 mm/s, without the stylus' weight.
  std::vector<std::string> notes;     ///< Missing or doubtful data, one line each.
  double seconds = 0.0;               ///< Duration of opening.
  std::vector<OpenPart> parts;        ///< Durations of its parts.

  /// Image plane of the transducer as the case begins.
  metrics::ImagePlane plane() const;
};

struct OpenOptions {
  /// A previous case; its patient and its display data are reused if the patient is the same.
  std::shared_ptr<const OpenCase> previous;
  /// Cache of embedded patients (PatientCache), from which they and the servers' scenes open faster the next time.
  /// Empty: they are generated each time. The usual folder is `io::patient_cache_folder()`.
  std::filesystem::path cache_folder;
  /// Makes or reads a patient that is not in the cache; empty: io::load_source. Benchmarks generate finer patients.
  std::function<Result<anatomy::VirtualPatient>(const io::PatientSource&, const Progress&)> load = nullptr;
};

/// Opens a case; slow parts run in parallel, and those that an attempt does not need later (OpenCase::later). `stop` is
/// checked between the parts. Errors: the patient, the tables, no path for this task (with the obstacle).
Result<std::shared_ptr<const OpenCase>> make_open_case(const CaseChoice& choice, const OpenOptions& options = {},
                                                       const Progress& progress = {}, const std::stop_token& stop = {});
/// The same in the background.
BackgroundJob<std::shared_ptr<const OpenCase>> open_case(CaseChoice choice, OpenOptions options);
BackgroundJob<std::shared_ptr<const OpenCase>> open_case(CaseChoice choice,
                                                         std::shared_ptr<const OpenCase> previous = nullptr);

/// Force along a case's planned path with other tissue numbers ("liver.k=0.5") and force model (empty: the case's): the
/// force that a trainee would feel at 10 mm/s. Errors: an unknown name, a number out of range (exit status 2).
Result<std::vector<CurvePoint>> predict_force(const Case& the_case, const std::vector<std::string>& overrides,
                                              const std::string& force_model);
BackgroundJob<std::vector<CurvePoint>> predict_force_in_background(std::shared_ptr<const OpenCase> open_case,
                                                                   std::vector<std::string> overrides,
                                                                   std::string force_model = {});

}  // namespace trocar::cases
