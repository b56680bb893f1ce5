// Forces of a fingertip and a transducer on the embedded patient in newtons, for docs/validation.md, and the cost of
// their tick.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>

#include "bench/benchmarks.h"
#include "bench/calibration.h"
#include "cases/prepare_case.h"
#include "haptics/tick.h"
#include "phantom/phantom.h"
#include "volume/sampling.h"

namespace trocar::bench {
namespace {

constexpr double kPress_mm_per_s = 20.0;

Figures one(double value) {
  Figures figures;
  figures.median = value;
  return figures;
}

/// A position on the skin: foot point and outward normal.
struct Place {
  Vec3 p_P;
  Vec3 normal_P;
};

Place on_skin(const anatomy::VirtualPatient& patient, Vec3 p_P) {
  const volume::FloatGrid& distance = patient.skin_distance_mm;
  Vec3 normal = volume::gradient_per_mm(distance, p_P).normalized();
  for (int i = 0; i < 10; ++i) {
    p_P -= volume::sample_linear(distance, p_P) * normal;
    normal = volume::gradient_per_mm(distance, p_P).normalized();
  }
  return {p_P, normal};
}

/// The tool's +y points into the skin, rotated by `tilt_rad` about the elevation axis; x is perpendicular to the body's
/// axis.
Pose pose_on(const Place& place, double height_mm, double tilt_rad) {
  const Vec3 y = -place.normal_P;
  const Vec3 z = (Vec3::UnitZ() - y * y.z()).normalized();
  Mat3 R;
  R.col(0) = y.cross(z);
  R.col(1) = y;
  R.col(2) = z;
  return {R * Eigen::AngleAxisd(tilt_rad, Vec3::UnitZ()).toRotationMatrix(), place.p_P + height_mm * place.normal_P};
}

struct Press {
  double at_depth_n = 0.0;   ///< Force on the finger at the target indentation; NaN: not reached.
  double at_force_mm = 0.0;  ///< Indentation at the target force.
  double torque_nmm = 0.0;   ///< About the tool's elevation axis, at the target indentation.
};

/// Presses the device straight in until the virtual tool has indented `depth_mm` and the force is `force_n`.
Press press(const haptics::HapticScene& scene, const Place& place, double depth_mm, double force_n,
            double tilt_rad = 0.0) {
  constexpr double kWay_mm = 60.0;
  haptics::ContactState state;
  Press result{std::nan(""), std::nan(""), 0.0};
  for (double way = -3.0; way < kWay_mm; way += kPress_mm_per_s * kDt_s) {
    const Pose X_PT = pose_on(place, -way, tilt_rad);
    const haptics::ContactStep step = haptics::step_contact(state, scene, X_PT, kDt_s);
    const double indented = place.normal_P.dot(place.p_P - state.X_PT.p());
    const double force = step.wrench_P.force_n.dot(place.normal_P);
    if (std::isnan(result.at_depth_n) && indented >= depth_mm) {
      result.at_depth_n = force;
      result.torque_nmm = X_PT.R().col(2).dot(step.wrench_P.torque_nmm);
    }
    if (std::isnan(result.at_force_mm) && force >= force_n) result.at_force_mm = indented;
    if (!std::isnan(result.at_depth_n) && !std::isnan(result.at_force_mm)) break;
  }
  return result;
}

constexpr double kFingerDepth_mm = 5.0;
constexpr double kFingerForce_n = 5.0;

/// Secant stiffness at the force or the depth; both are in the note.
CaseResult finger_case(const std::string& name, const Press& pressed, const std::string& where) {
  return {"palpation/" + name,
          "n",
          one(pressed.at_depth_n),
          {},
          fmt::format("{}: {:.2f} N/mm at 5 mm; {:.1f} mm at 5 N, {:.2f} N/mm", where, pressed.at_depth_n / 5.0,
                      pressed.at_force_mm, kFingerForce_n / pressed.at_force_mm),
          {{"mm_at_5_n", pressed.at_force_mm}}};
}

/// Presses along a line on the skin: the stiffest and the softest position, and their ratio.
void add_line(std::vector<CaseResult>& results, const haptics::HapticScene& scene, const Vec3& from_P, const Vec3& to_P,
              const std::string& hard, const std::string& soft) {
  constexpr double kStep_mm = 2.0;
  const double length = (to_P - from_P).norm();
  struct Best {
    double n;
    double at_mm;
    Press pressed;
  };
  Best hardest{-1.0, 0.0, {}};
  Best softest{1e9, 0.0, {}};
  for (double at = 0.0; at <= length; at += kStep_mm) {
    const Place place = on_skin(*scene.patient, from_P + (to_P - from_P) * (at / length));
    const Press pressed = press(scene, place, kFingerDepth_mm, kFingerForce_n);
    if (!(pressed.at_depth_n > 0.0)) continue;
    if (pressed.at_depth_n > hardest.n) hardest = {pressed.at_depth_n, at, pressed};
    if (pressed.at_depth_n < softest.n) softest = {pressed.at_depth_n, at, pressed};
  }
  results.push_back(finger_case(hard, hardest.pressed, fmt::format("{:.0f} mm along the line", hardest.at_mm)));
  results.push_back(finger_case(soft, softest.pressed, fmt::format("{:.0f} mm along the line", softest.at_mm)));
  results.push_back({fmt::format("palpation/{}-to-{}", hard, soft),
                     "ratio",
                     one(hardest.n / softest.n),
                     {},
                     "forces at 5 mm; 1.07 is just noticeable (Pang, Tan, Durlach)"});
  results.push_back({fmt::format("palpation/{}-to-{}-5-n", hard, soft),
                     "ratio",
                     one(softest.pressed.at_force_mm / hardest.pressed.at_force_mm),
                     {},
                     "stiffness at 5 N"});
}

Vec3 landmark(const anatomy::VirtualPatient& patient, std::string_view name) {
  const auto found = std::ranges::find(patient.landmarks, name, &anatomy::Landmark::name);
  return found != patient.landmarks.end() ? found->p_P : Vec3(Vec3::Zero());
}

Result<std::shared_ptr<const haptics::HapticScene>> scene_for(
    const std::shared_ptr<const anatomy::VirtualPatient>& patient, const anatomy::TissueTable& tissues,
    haptics::Tool tool) {
  haptics::HapticOptions options;
  options.tool = tool;
  return haptics::make_haptic_scene(patient, tissues, {}, {}, options);
}

/// A block of soft tissue (5 kPa) with a stiff ball (60 kPa), whose top is 10 mm below the skin.
Status add_tumour(std::vector<CaseResult>& results, const anatomy::TissueTable& table) {
  anatomy::TissueTable tissues = table;
  const auto soft = tissues.find_tissue("liver");
  const auto hard = tissues.find_tissue("liver_lesion");
  if (!soft || !hard) return fail("has no liver or liver_lesion", "tissue table", "add both tissues");
  tissues.tissues[*soft].young_kpa = 5.0;
  tissues.tissues[*hard].young_kpa = 60.0;
  tissues.tissues[tissues.skin].young_kpa = 5.0;
  auto patient = std::make_shared<anatomy::VirtualPatient>();
  patient->name = "tumour";
  patient->label_table.labels = {{1, "soft", "liver"}, {2, "tumour", "liver_lesion"}};
  volume::GridGeometry geometry;
  geometry.size = {121, 71, 61};  // skin at y = 0, the front of a supine patient
  geometry.origin_P = {-30.0, -10.0, -30.0};
  patient->labels = volume::LabelGrid(geometry, 0);
  patient->skin_distance_mm = volume::FloatGrid(geometry, 0.0F);
  const Vec3 centre(0.0, 20.0, 0.0);
  for (std::size_t n = 0; n < patient->labels.voxels.size(); ++n) {
    const volume::Index3 ijk = geometry.index_of(n);
    const Vec3 p = geometry.origin_P + volume::to_vec3(ijk);
    patient->skin_distance_mm.voxels[n] = static_cast<float>(-p.y());
    if (p.y() >= 0.0) patient->labels.voxels[n] = (p - centre).norm() < 10.0 ? 2 : 1;
  }
  TROCAR_TRY(const auto scene, scene_for(patient, tissues, haptics::Tool::kFinger));
  add_line(results, *scene, {0.0, 0.0, 0.0}, {60.0, 0.0, 0.0}, "tumour", "beside-tumour");
  return {};
}

/// Force and torque of the transducer, flat and tilted.
void add_probe(std::vector<CaseResult>& results, const haptics::HapticScene& scene, const Vec3& p_P,
               const std::string& name) {
  constexpr double kDepth_mm = 10.0;
  constexpr double kTilt_rad = radians(10.0);
  const Place place = on_skin(*scene.patient, p_P);
  const Press flat = press(scene, place, kDepth_mm, 0.0);
  const Press tilted = press(scene, place, kDepth_mm, 0.0, kTilt_rad);
  results.push_back(
      {"probe/" + name,
       "n",
       one(flat.at_depth_n),
       {},
       fmt::format("10 mm deep, {:.2f} N/mm, torque {:.1f} N mm", flat.at_depth_n / kDepth_mm, flat.torque_nmm)});
  results.push_back({fmt::format("probe/{}-tilted-10-deg", name),
                     "mm",
                     one((flat.torque_nmm - tilted.torque_nmm) / tilted.at_depth_n),
                     {},
                     fmt::format("lever that rights it: {:.1f} N mm at {:.1f} N", flat.torque_nmm - tilted.torque_nmm,
                                 tilted.at_depth_n),
                     {{"torque_nmm", flat.torque_nmm - tilted.torque_nmm}}});
}

/// Slides the pressed tool over the skin; a calibration after each tick.
void add_time(std::vector<CaseResult>& results, const haptics::HapticScene& scene, const Vec3& from_P, const Vec3& to_P,
              double depth_mm, const std::string& name) {
  constexpr int kTicks = 5000;
  const auto state = std::make_unique<haptics::HapticState>();
  volatile double sink = 0.5;
  Figures tick_us;
  Figures calibration_us;
  int points = 0;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> ticks;
    std::vector<double> calibrations;
    for (int i = 0; i < kTicks; ++i) {
      const double way = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * i / kTicks);
      const Place place = on_skin(*scene.patient, from_P + way * (to_P - from_P));
      const haptics::HapticInput input{
          i * kDt_s, kDt_s, telemetry::to_tool_pose(pose_on(place, -depth_mm, 0.0)), true, {}};
      ticks.push_back(time_us([&] { sink = sink + haptics::tick(*state, input, scene).total_W.force_n.x(); }));
      calibrations.push_back(time_us([&] { sink = calibration_arithmetic(sink); }));
      if (i == 0)
        points = static_cast<int>(std::ranges::count_if(state->contact.depth_mm, [](double d) { return d > 0.0; }));
    }
    const Figures figures = figures_of(std::move(ticks));
    if (round > 0 && *figures.median >= *tick_us.median) continue;
    tick_us = figures;
    calibration_us = figures_of(std::move(calibrations));
  }
  results.push_back({"calibration/arithmetic", "us", calibration_us, {}, "a fixed loop, after each tick"});
  results.push_back(
      {"tick/" + name,
       "us",
       tick_us,
       {},
       fmt::format("{} points in contact at the start, {} ticks, best of {} rounds", points, kTicks, kRounds)});
  results.push_back({fmt::format("tick/{}-to-calibration", name),
                     "ratio",
                     one(*tick_us.median / *calibration_us.median),
                     {},
                     "of the medians"});
}

}  // namespace

Result<std::vector<CaseResult>> run_palpation_benchmark() {
  TROCAR_TRY(const cases::Case tables, cases::load_tables({}));
  TROCAR_TRY(anatomy::VirtualPatient generated, phantom::generate_phantom("abdomen", 1, {{512, 512, 119}}));
  const auto patient = std::make_shared<const anatomy::VirtualPatient>(std::move(generated));
  TROCAR_TRY(const auto finger, scene_for(patient, tables.tissues, haptics::Tool::kFinger));
  TROCAR_TRY(const auto probe, scene_for(patient, tables.tissues, haptics::Tool::kTransducer));

  std::vector<CaseResult> results;
  const Vec3 flank = landmark(*patient, "right mid-axillary line, tenth rib");
  const Vec3 costal(flank.x() * 0.85, flank.x() * 0.5, 60.0);  // right, in front of the axilla, over ribs 7 to 9
  const Vec3 umbilicus = landmark(*patient, "umbilicus");
  const Vec3 xiphoid = landmark(*patient, "xiphoid");
  const Vec3 spine = landmark(*patient, "spinous process L3");
  add_line(results, *finger, costal - Vec3(0, 0, 30), costal + Vec3(0, 0, 30), "rib", "between-ribs");
  add_line(results, *finger, spine, spine + Vec3(30, 0, 0), "spinous-process", "beside-the-spine");
  add_line(results, *finger, xiphoid, xiphoid + (umbilicus - xiphoid) * 0.7, "xiphoid", "belly");
  TROCAR_TRY_STATUS(add_tumour(results, tables.tissues));
  const Vec3 belly = xiphoid + (umbilicus - xiphoid) * 0.7;
  add_probe(results, *probe, belly, "belly");
  add_probe(results, *probe, costal, "ribs");
  add_time(results, *probe, belly, belly + Vec3(20, 0, 0), 12.0, "transducer");
  add_time(results, *finger, belly, belly + Vec3(20, 0, 0), 8.0, "finger");
  return results;
}

}  // namespace trocar::bench
