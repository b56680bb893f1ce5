#include "bench/haptics/passivity_motions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "cases/scene_request.h"
#include "core/files/folders.h"
#include "phantom/phantom.h"
#include "tasks/needle.h"
#include "volume/sampling.h"

namespace trocar::bench {
namespace {

constexpr std::array kPassivePatients{"layers-lumbar", "layers-ascites", "layers-liver", "abdomen", "lumbar-1"};
constexpr double kElasticShare = 0.3;
constexpr double kWidestAngle_rad = radians(80.0);
constexpr double kElasticTempo_mm_per_s = 60.0;  // a motion without losses does not depend on its speed

template <class List>
const auto& any_of_list(const List& list, Random& random) {
  return list[static_cast<std::size_t>(random.uniform() * static_cast<double>(list.size()))];
}

/// Thinner than all listed needles: 25 G, and the suture needle of physics.md P7.
void add_fine_needles(std::vector<NamedNeedle>& needles) {
  haptics::NeedleGeometry fine;
  fine.length_mm = 90.0;
  fine.radius_mm = 0.257;
  needles.push_back({"25g", fine});
  fine.radius_mm = 0.125;
  needles.push_back({"0.25mm", fine});
}

Vec3 onto_skin(const volume::FloatGrid& distance, Vec3 p_P) {
  constexpr int kSteps = 20;
  for (int i = 0; i < kSteps; ++i)
    p_P -= volume::sample_linear(distance, p_P) * volume::gradient_per_mm(distance, p_P).normalized();
  return p_P;
}

Vec3 any_across(const Vec3& axis, Random& random) {
  const Vec3 any = std::abs(axis.x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 side = axis.cross(any).normalized();
  const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
  return std::cos(angle) * side + std::sin(angle) * axis.cross(side);
}

/// A place within 15 mm of the patient's path. `angle_rad`: to the skin's normal.
haptics::MotionPlace random_place(const anatomy::VirtualPatient& patient, double angle_rad, Random& random) {
  constexpr double kBeside_mm = 15.0;
  const Segment& line_P = patient.paths.front().line_P;
  const volume::FloatGrid& distance = patient.skin_distance_mm;
  haptics::MotionPlace place;
  place.skin_P =
      onto_skin(distance, line_P.a + random.uniform(0.0, kBeside_mm) * any_across(line_P.direction(), random));
  place.inward_P = -volume::gradient_per_mm(distance, place.skin_P).normalized();
  place.axis_P = std::cos(angle_rad) * place.inward_P + std::sin(angle_rad) * any_across(place.inward_P, random);
  return place;
}

double random_tempo(Random& random) {
  const double share = random.uniform();
  if (share < 0.04) return random.uniform(1.0, 2.0);
  if (share < 0.15) return random.uniform(2.0, 10.0);
  return 10.0 * std::pow(33.0, random.uniform());
}

haptics::HapticOptions options_of(MovedModel model) {
  haptics::HapticOptions options;
  options.has_weight_compensation = false;  // a constant load of the device, not of the tissue
  if (model == MovedModel::kProxy) options.force_model = haptics::ForceModel::kProxy;
  if (model == MovedModel::kCombined) options.force_model = haptics::ForceModel::kCombined;
  if (model == MovedModel::kProbe) options.tool = haptics::Tool::kTransducer;
  if (model == MovedModel::kFinger) options.tool = haptics::Tool::kFinger;
  return options;
}

bool is_needle(MovedModel model) {
  return model != MovedModel::kProbe && model != MovedModel::kFinger;
}

haptics::MotionKind random_kind(MovedModel model, Random& random) {
  const bool is_lossless = random.uniform() < kElasticShare;
  if (!is_needle(model))
    return is_lossless ? haptics::MotionKind::kElasticSkin : any_of_list(haptics::kFaceKinds, random);
  return is_lossless ? any_of_list(haptics::kElasticKinds, random) : any_of_list(haptics::kNeedleKinds, random);
}

double random_angle(haptics::MotionKind kind, MovedModel model, Random& random) {
  constexpr double kFace_rad = 0.6, kChannel_rad = 0.9;
  double widest = is_needle(model) ? kWidestAngle_rad : kFace_rad;
  if (kind == haptics::MotionKind::kElasticChannel || kind == haptics::MotionKind::kElasticWall) widest = kChannel_rad;
  return widest * random.uniform();
}

using ScenePtr = std::shared_ptr<const haptics::HapticScene>;

Result<ScenePtr> scene_of(const std::shared_ptr<const anatomy::VirtualPatient>& patient, anatomy::TissueTable tissues,
                          const haptics::NeedleGeometry& needle, MovedModel model, haptics::MotionKind kind) {
  haptics::HapticOptions options = options_of(model);
  const bool is_lossless = haptics::is_elastic(kind);
  if (is_lossless) haptics::remove_losses(tissues, options);
  if (kind == haptics::MotionKind::kElasticSkin) haptics::close_layers(tissues, haptics::ClosedLayers::kAll);
  if (kind == haptics::MotionKind::kElasticWall) haptics::close_layers(tissues, haptics::ClosedLayers::kAllButSkin);
  TROCAR_TRY(ScenePtr scene, haptics::make_haptic_scene(patient, tissues, needle, {}, options));
  if (!is_lossless || is_needle(model)) return scene;
  auto slippery = std::make_shared<haptics::HapticScene>(*scene);
  slippery->face.friction_mu = 0.0;
  return ScenePtr(std::move(slippery));
}

/// How far the tool may go: by the puncture force of the skin, and by the needle's length.
void limit_place(haptics::MotionPlace& place, const haptics::HapticScene& scene, MovedModel model,
                 haptics::MotionKind kind, Random& random) {
  constexpr double kFace_mm = 12.0, kSearch_mm = 45.0, kClosedSkin_mm = 15.0, kBehind_mm = 50.0;
  place.length_mm = scene.X_SN.p().norm();
  if (!is_needle(model)) {
    place.closed_mm = place.deepest_mm = random.uniform(2.0, kFace_mm);
    place.widest_rad = 0.2;
    return;
  }
  if (kind == haptics::MotionKind::kElasticSkin) {
    place.closed_mm = random.uniform(1.0, kClosedSkin_mm);
    return;
  }
  const auto puncture_mm = haptics::find_skin_puncture_mm(scene, place.skin_P, place.axis_P, kSearch_mm);
  place.closed_mm = puncture_mm.value_or(kClosedSkin_mm);
  place.deepest_mm = std::min(place.length_mm - 10.0, place.closed_mm + random.uniform(10.0, kBehind_mm));
}

}  // namespace

const char* to_string(MovedModel model) noexcept {
  constexpr std::array kNames{"insertion", "proxy", "combined", "probe", "finger"};
  return kNames[static_cast<std::size_t>(model)];
}

MovedModel model_of(int number) noexcept {
  constexpr int kOfEach = 3, kAll = 11;
  const int n = number % kAll;
  return n < 3 * kOfEach    ? static_cast<MovedModel>(n / kOfEach)
         : n == 3 * kOfEach ? MovedModel::kProbe
                            : MovedModel::kFinger;
}

Result<MotionPool> load_motion_pool(const Progress& progress) {
  TROCAR_TRY(const std::filesystem::path data, checked_data_dir());
  MotionPool pool;
  TROCAR_TRY(const auto profiles, anatomy::tissue_profiles(data / "tissues.toml"));
  for (const std::string& profile : profiles) {
    TROCAR_TRY(anatomy::TissueTable tissues, anatomy::load_tissue_table(data / "tissues.toml", profile));
    pool.tissues.push_back(std::move(tissues));
  }
  TROCAR_TRY(const auto needles, tasks::load_needles(data / "needles.toml"));
  for (const tasks::Needle& needle : needles) pool.needles.push_back({needle.name, cases::needle_geometry(needle)});
  add_fine_needles(pool.needles);
  for (const char* name : kPassivePatients) {
    TROCAR_TRY(anatomy::VirtualPatient patient, phantom::generate_phantom(name, 1, {}, progress));
    if (patient.paths.empty()) return fail("the patient has no needle path", name, "use an embedded patient");
    pool.patients.push_back(std::make_shared<const anatomy::VirtualPatient>(std::move(patient)));
  }
  return pool;
}

std::string PlannedMotion::text() const {
  return fmt::format("motion {}: {}, {:.0f} degrees, {:.0f} mm/s, {:.0f} Hz, {}, {}, {}", number,
                     haptics::to_string(kind), angle_deg, tempo_mm_per_s, rate_hz, patient, needle, profile);
}

Result<PlannedMotion> plan_motion(const MotionPool& pool, std::uint64_t seed, int number) {
  Random random(mix64(seed) ^ static_cast<std::uint64_t>(number));
  PlannedMotion planned;
  planned.number = number;
  planned.model = model_of(number);
  planned.kind = random_kind(planned.model, random);
  const auto& patient = any_of_list(pool.patients, random);
  const NamedNeedle& needle = any_of_list(pool.needles, random);
  const anatomy::TissueTable& tissues = any_of_list(pool.tissues, random);
  planned.patient = patient->name;
  planned.needle = is_needle(planned.model) ? needle.name : to_string(planned.model);
  planned.profile = tissues.profile;
  const double rate = random.uniform();
  planned.rate_hz = rate < 0.8 ? 1000.0 : rate < 0.9 ? 4000.0 : 250.0;
  planned.tempo_mm_per_s = random_tempo(random);
  if (haptics::is_elastic(planned.kind)) {
    planned.tempo_mm_per_s = kElasticTempo_mm_per_s;
    planned.rate_hz = std::max(planned.rate_hz, 1000.0);
  }
  const double angle_rad = random_angle(planned.kind, planned.model, random);
  planned.angle_deg = angle_rad * kDegPerRad;
  TROCAR_TRY(planned.scene, scene_of(patient, tissues, needle.geometry, planned.model, planned.kind));
  haptics::MotionPlace place = random_place(*patient, angle_rad, random);
  limit_place(place, *planned.scene, planned.model, planned.kind, random);
  place.tempo_mm_per_s = planned.tempo_mm_per_s;
  planned.before = haptics::motion_before(planned.kind, place);
  planned.motion = haptics::make_random_motion(planned.kind, place, random);
  return planned;
}

}  // namespace trocar::bench
