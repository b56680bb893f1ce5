#include "cases/open_case.h"

#include <array>
#include <chrono>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>

#include "cases/imaging.h"
#include "cases/scene_request.h"
#include "cases/transducer_start.h"
#include "core/files/folders.h"
#include "core/parallel.h"
#include "io/patient/patient_cache.h"
#include "io/patient/patient_extras.h"

namespace trocar::cases {
namespace {

constexpr double kPredictedSpeed_mm_per_s = 10.0;
constexpr double kPredictedPast_mm = 10.0;

/// Progress of parallel parts, combined into one.
class SharedProgress {
 public:
  explicit SharedProgress(const Progress& whole) : whole_(whole) {}
  /// `share`: of the whole, 0..1. This must outlive it.
  Progress part(double share) {
    const std::lock_guard lock(mutex_);
    const std::size_t index = done_.size();
    done_.push_back(0.0);
    return [this, share, index](std::string_view step, double fraction) {
      const std::lock_guard own_lock(mutex_);
      done_[index] = share * fraction;
      report(whole_, step, std::accumulate(done_.begin(), done_.end(), 0.0));
    };
  }

 private:
  const Progress& whole_;
  std::mutex mutex_;
  std::vector<double> done_;
};

bool is_same_patient(const CaseChoice& a, const CaseChoice& b) {
  return a.patient_source == b.patient_source && a.patient_seed == b.patient_seed;
}

io::PatientSource source_of(const CaseChoice& choice) {
  return {choice.patient_source, choice.patient_seed};
}

/// The patient, from the cache if possible; `made.server_source` is its source for servers.
Result<std::shared_ptr<const anatomy::VirtualPatient>> patient_of(OpenCase& made, const OpenOptions& options,
                                                                  const Progress& progress) {
  const io::PatientCache cache(options.cache_folder);
  made.server_source = made.choice.patient_source;
  if (const auto kept = cache.find(source_of(made.choice))) {
    if (auto patient = io::open_patient({kept->string(), 1}, progress)) {
      made.server_source = kept->string();
      return std::make_shared<const anatomy::VirtualPatient>(*std::move(patient));
    }
    cache.forget(source_of(made.choice));
  }
  TROCAR_TRY(anatomy::VirtualPatient patient, options.load ? options.load(source_of(made.choice), progress)
                                                           : io::load_source(source_of(made.choice), progress));
  return std::make_shared<const anatomy::VirtualPatient>(std::move(patient));
}

/// Keeps a new patient, from where the servers read it; returns their source. If it cannot be kept, they make it again.
std::string keep_patient(const OpenCase& made, const anatomy::VirtualPatient& patient, const io::PatientCache& cache) {
  const bool is_new = made.server_source == made.choice.patient_source;
  if (!is_new || io::is_path(made.choice.patient_source)) return made.server_source;
  const auto kept = cache.keep(source_of(made.choice), patient);
  return kept ? kept->string() : made.server_source;
}

Result<std::shared_ptr<LaterData>> begin_later(const CaseChoice& choice,
                                               std::shared_ptr<const anatomy::VirtualPatient> patient,
                                               LaterData::First first, const OpenOptions& options) {
  TROCAR_TRY(ultrasound::AcousticTable acoustics, ultrasound::load_acoustic_table(data_dir() / "acoustics.toml"));
  TROCAR_TRY_STATUS(ultrasound::check_acoustic_scene(*patient, acoustics));
  io::PatientSource source = source_of(choice);
  source.cache_folder = options.cache_folder;
  return std::make_shared<LaterData>(std::move(patient), std::move(acoustics), std::move(source), first);
}

Result<std::shared_ptr<ultrasound::FlowOnDemand>> flow_of(std::shared_ptr<const anatomy::VirtualPatient> patient) {
  TROCAR_TRY(ultrasound::FlowTable flows, ultrasound::load_flow_table(data_dir() / "flow.toml"));
  return std::make_shared<ultrasound::FlowOnDemand>(std::move(patient), std::move(flows));
}

/// Only notes where the panorama is: it is loaded when an image uses it.
void add_panorama(OpenCase& made, const OpenCase* previous) {
  const io::PatientSource source = source_of(made.choice);
  if (previous != nullptr) {
    made.panorama = previous->panorama;
  } else if (io::has_panorama(source)) {
    made.panorama = std::make_shared<ultrasound::PanoramaOnDemand>([source] { return io::load_panorama(source); });
  }
  if (!made.panorama && made.the_case.task.ultrasound_engine == "panorama")
    made.notes.push_back("ultrasound is ray cast: the patient has no panorama — stitch and register one");
}

Status add_case(OpenCase& made, std::shared_ptr<const anatomy::VirtualPatient> patient, const Progress& progress) {
  TROCAR_TRY(made.the_case, prepare_case(std::move(patient), made.choice.options, progress));
  made.force_model = made.choice.force_model.empty() ? made.the_case.task.force_model : made.choice.force_model;
  TROCAR_TRY(TransducerStart start, find_transducer_start(*made.the_case.patient, made.the_case.plan.line_P));
  made.transducer = std::move(start.transducer);
  made.probe_depth_mm = start.depth_mm;
  made.X_PT_start = start.X_PT;
  made.is_in_plane = start.is_in_plane;
  if (!start.note.empty()) made.notes.push_back(start.note);
  TROCAR_TRY(made.neutral, find_neutral_start(made.the_case, made.transducer, made.X_PT_start));
  if (!made.neutral.note.empty()) made.notes.push_back(made.neutral.note);
  return {};
}

Result<std::shared_ptr<const haptics::HapticScene>> scene_of(const Case& the_case, const anatomy::TissueTable& tissues,
                                                             const std::string& force_model) {
  haptics::HapticOptions haptics;
  haptics.has_weight_compensation = false;
  TROCAR_TRY(haptics.force_model, haptics::parse_force_model(force_model));
  return haptics::make_haptic_scene(the_case.patient, tissues, needle_geometry(the_case.needle), {}, haptics);
}

std::vector<CurvePoint> curve_of(const Case& the_case, const haptics::HapticScene& scene) {
  PrescribedMotion motion;
  motion.line_P = the_case.plan.line_P;
  motion.speed_mm_per_s = kPredictedSpeed_mm_per_s;
  motion.after_mm = kPredictedPast_mm;
  return force_curve(scene, motion);
}

Status add_prediction(OpenCase& made) {
  TROCAR_TRY(const auto scene, scene_of(made.the_case, made.the_case.tissues, made.force_model));
  made.pieces = pieces_along(*scene, made.the_case.tissues, made.the_case.plan.line_P);
  made.predicted = curve_of(made.the_case, *scene);
  return {};
}

}  // namespace

bool operator==(const CaseChoice& a, const CaseChoice& b) {
  const CaseOptions &x = a.options, &y = b.options;
  return is_same_patient(a, b) && a.force_model == b.force_model && x.task == y.task && x.needle == y.needle &&
         x.tissue_file == y.tissue_file && x.profile == y.profile && x.overrides == y.overrides && x.level == y.level &&
         x.breathing == y.breathing && x.held_phase == y.held_phase && x.seed == y.seed;
}

Result<std::shared_ptr<const OpenCase>> make_open_case(const CaseChoice& choice, const OpenOptions& options,
                                                       const Progress& progress, const std::stop_token& stop) {
  const auto begin = std::chrono::steady_clock::now();
  auto made = std::make_shared<OpenCase>();
  made->choice = choice;
  made->choice.options.patient_folder = choice.patient_source;  // path of the patient's own task, if any
  std::shared_ptr<const OpenCase> previous = options.previous;
  if (previous && !is_same_patient(previous->choice, choice)) previous.reset();
  // Errors of the tables are reported before a patient is opened.
  TROCAR_TRY_STATUS(load_tables(made->choice.options));
  SharedProgress shared(progress);
  OpenParts parts;
  std::shared_ptr<const anatomy::VirtualPatient> patient;
  if (previous) {
    patient = previous->the_case.patient;
    made->server_source = previous->server_source;
    made->later = previous->later;
    made->flow = previous->flow;
    TROCAR_TRY_STATUS(add_case(*made, patient, shared.part(0.9)));
  } else {
    TROCAR_TRY(patient, parts.measure("patient", [&] { return patient_of(*made, options, shared.part(0.6)); }));
    if (stop.stop_requested()) return fail("the case was not opened: cancelled", "case", "open it again");
    Status has_case;
    const Progress of_case = shared.part(0.3);
    std::string server_source;
    const io::PatientCache cache(options.cache_folder);
    parallel_invoke(
        [&] { has_case = parts.measure("plan", [&] { return add_case(*made, patient, of_case); }); },
        [&] { server_source = parts.measure("cache", [&] { return keep_patient(*made, *patient, cache); }); });
    TROCAR_TRY_STATUS(std::move(has_case));
    made->server_source = std::move(server_source);
    TROCAR_TRY(made->flow, flow_of(patient));
    TROCAR_TRY(made->later, begin_later(choice, patient,
                                        made->the_case.task.guidance == tasks::ImagingModality::kUltrasound
                                            ? LaterData::First::kUltrasound
                                            : LaterData::First::kSurfaces,
                                        options));
  }
  add_panorama(*made, previous.get());
  if (!made->flow->is_possible())
    made->notes.push_back(
        "no colour Doppler: no vessel of this patient has flow — label some, or add rows to flow.toml");
  if (stop.stop_requested()) return fail("the case was not opened: cancelled", "case", "open it again");
  report(progress, "predicting the force", 0.95);
  TROCAR_TRY_STATUS(parts.measure("predicted force", [&] { return add_prediction(*made); }));
  made->parts = parts.take();
  made->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  report(progress, "open", 1.0);
  return std::shared_ptr<const OpenCase>(std::move(made));
}

BackgroundJob<std::shared_ptr<const OpenCase>> open_case(CaseChoice choice, OpenOptions options) {
  return BackgroundJob<std::shared_ptr<const OpenCase>>([choice = std::move(choice), options = std::move(options)](
                                                            const Progress& progress, const std::stop_token& stop) {
    return make_open_case(choice, options, progress, stop);
  });
}

BackgroundJob<std::shared_ptr<const OpenCase>> open_case(CaseChoice choice, std::shared_ptr<const OpenCase> previous) {
  return open_case(std::move(choice), OpenOptions{std::move(previous), {}});
}

Result<std::vector<CurvePoint>> predict_force(const Case& the_case, const std::vector<std::string>& overrides,
                                              const std::string& force_model) {
  anatomy::TissueTable tissues = the_case.tissues;
  for (const std::string& assignment : overrides) TROCAR_TRY_STATUS(anatomy::apply_override(tissues, assignment));
  TROCAR_TRY(const auto scene,
             scene_of(the_case, tissues, force_model.empty() ? the_case.task.force_model : force_model));
  return curve_of(the_case, *scene);
}

BackgroundJob<std::vector<CurvePoint>> predict_force_in_background(std::shared_ptr<const OpenCase> open_case,
                                                                   std::vector<std::string> overrides,
                                                                   std::string force_model) {
  if (force_model.empty()) force_model = open_case->force_model;
  return BackgroundJob<std::vector<CurvePoint>>([open_case = std::move(open_case), overrides = std::move(overrides),
                                                 force_model = std::move(force_model)](const Progress&) {
    return predict_force(open_case->the_case, overrides, force_model);
  });
}

metrics::ImagePlane OpenCase::plane() const {
  return image_plane(transducer, probe_depth_mm);
}

}  // namespace trocar::cases
