// trocar xray: an X-ray image of a patient, with needle and contrast agent.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "cases/imaging.h"
#include "cli/commands.h"
#include "cli/constants.h"
#include "cli/patient_option.h"
#include "cli/ultrasound/scan.h"
#include "cli/xray/arguments.h"
#include "config/json.h"
#include "core/files/folders.h"
#include "dicom/xa/xa_file.h"
#include "io/image/image_file.h"
#include "io/patient/patient_cache.h"
#include "io/sequence/transform_file.h"
#include "png/png_file.h"
#include "ultrasound/doppler/vessel_flow.h"
#include "xray/contrast/contrast_flow.h"
#include "xray/fluoroscopy/fluoroscope.h"

namespace trocar::cli {
namespace {
namespace fs = std::filesystem;

constexpr double kStep_s = 0.05;  // of the contrast agent
constexpr int kMaskFrames = xray::Fluoroscope::kMaskFrames;
constexpr double kPulses_per_s = 15.0;

/// The room before the first pulse.
struct Room {
  std::shared_ptr<const anatomy::VirtualPatient> patient;
  std::optional<xray::Fluoroscope> fluoroscope;
  motion::MotionDrive breathing;
  xray::FluoroscopyRequest request;
  std::optional<xray::ContrastFlow> flow;
  std::optional<Injection> injection;
  double iodine_mg_per_ml = 0.0;  ///< Of the contrast agent.
};

/// Mean place of the body's voxels; the grid's centre if there is none.
Vec3 body_centre_P(const volume::FloatGrid& skin_distance_mm) {
  const volume::GridGeometry& geometry = skin_distance_mm.geometry;
  Vec3 sum = Vec3::Zero();
  double count = 0.0;
  for (std::size_t n = 0; n < skin_distance_mm.voxels.size(); ++n)
    if (skin_distance_mm.voxels[n] < 0.0F) {
      sum += volume::to_vec3(geometry.index_of(n));
      count += 1.0;
    }
  const volume::Index3 last{geometry.size[0] - 1, geometry.size[1] - 1, geometry.size[2] - 1};
  return geometry.to_mm(count > 0.0 ? Vec3(sum / count) : Vec3(0.5 * volume::to_vec3(last)));
}

/// Where the arm looks without --at: the needle's tip, the injection, the target of the patient's task, or the centre
/// of the body.
Vec3 middle_P(const Room& room, const std::optional<Pose>& X_PN) {
  if (X_PN) return X_PN->p();
  if (room.injection) return room.injection->place_P;
  const std::vector<anatomy::NeedlePath>& paths = room.patient->paths;
  if (paths.empty()) return body_centre_P(room.patient->skin_distance_mm);
  // "TASK: place" is a path of the task that the patient was made for; abdomens have a biopsy's path before it.
  const auto stated = std::ranges::find_if(
      paths, [](const anatomy::NeedlePath& path) { return path.name.find(": ") != std::string::npos; });
  return (stated != paths.end() ? *stated : paths.front()).line_P.b;
}

xray::ToolShape needle_of(const Pose& X_PN, double diameter_mm) {
  xray::ToolShape needle;
  needle.name = "needle";
  needle.line_P = {X_PN * Vec3(0.0, 0.0, -kNeedleLength_mm), X_PN.p()};
  needle.outer_radius_mm = 0.5 * diameter_mm;
  return needle;
}

/// Whether a ray meets the body between source and detector.
bool is_body_in_beam(const xray::XrayVolume& volume, const xray::CArm& arm) {
  constexpr int kPlaces = 17;  // along each edge of the detector
  constexpr double kApart_mm = 5.0;
  const xray::XrayRays rays = xray::rays_of(arm);
  const double share = (arm.pixels - 1.0) / (kPlaces - 1), step = kApart_mm / arm.source_detector_mm;
  for (int row = 0; row < kPlaces; ++row)
    for (int column = 0; column < kPlaces; ++column) {
      const Vec3 ray_P = rays.pixel_P(column * share, row * share) - rays.source_P;
      for (double at = 0.0; at < 1.0; at += step)
        if (volume.is_inside_body(rays.source_P + at * ray_P)) return true;
    }
  return false;
}

/// Usage errors: source or detector inside the body, no ray meets the body.
Status check_beam(const xray::XrayVolume& volume, const xray::CArm& arm) {
  TROCAR_TRY_STATUS(xray::check_source(volume, arm));
  if (is_body_in_beam(volume, arm)) return {};
  const Vec3& p = arm.isocentre_P;
  return fail_usage("the X-ray beam misses the patient", fmt::format("C-arm at {:g},{:g},{:g}", p.x(), p.y(), p.z()),
                    "give a place in the patient with --at");
}

/// Warns of a needle that the image does not show as it lies in the patient.
void warn_of_needle(const Room& room, const Vec3& tip_P) {
  const volume::GridGeometry& ct = room.patient->ct.geometry;
  const Vec3 index = ct.to_index(tip_P);
  const bool is_in_ct = (index.array() >= -0.5).all() && index.x() <= static_cast<double>(ct.size[0]) - 0.5 &&
                        index.y() <= static_cast<double>(ct.size[1]) - 0.5 &&
                        index.z() <= static_cast<double>(ct.size[2]) - 0.5;
  const auto [column, row] = xray::rays_of(room.request.arm).project(tip_P);
  const xray::FieldPixels field = xray::field_pixels(room.request.arm);
  const bool is_shown =
      column > field.first_column && column < field.last_column && row > field.first_row && row < field.last_row;
  const std::string place = fmt::format("{:g},{:g},{:g}", tip_P.x(), tip_P.y(), tip_P.z());
  if (!is_in_ct) print_warning(fmt::format("the needle's tip is outside of the patient's CT — {}", place));
  if (is_in_ct && !is_shown)
    print_warning(fmt::format("the needle's tip is outside of the image — {} — give it with --at", place));
}

/// Blood that carries an injection away; followed only for an injection into a vessel.
xray::BloodVelocity blood_of(const Room& room) {
  const anatomy::Label* const label = anatomy::find_label(*room.patient, room.injection->place_P);
  const bool is_vessel = label != nullptr && ultrasound::is_vessel(*label);
  return is_vessel ? cases::contrast_blood(*room.patient) : xray::BloodVelocity();
}

/// The contrast agent's flow. Usage error: the injection is outside of the body.
Status prepare_contrast(const XrayArguments& a, Room& room) {
  TROCAR_TRY(const xray::ContrastTable table, xray::load_contrast_table(data_dir() / "contrast.toml"));
  room.iodine_mg_per_ml = table.iodine_mg_per_ml;
  TROCAR_TRY(room.flow, xray::ContrastFlow::make(room.patient, table, blood_of(room)));
  if (room.flow->place(room.injection->place_P) == xray::ContrastPlace::kOutside)
    return fail_usage("--contrast is outside of the patient", a.contrast, "give a place in the body");
  return {};
}

Result<Room> prepare_room(const XrayArguments& a, const Progress& progress) {
  Room room;
  std::optional<Pose> X_PN;
  if (!a.needle.empty()) {
    TROCAR_TRY(X_PN, io::read_transform(a.needle));
  }
  TROCAR_TRY(room.injection, parse_injection(a.contrast, a.rate_ml_per_s));
  TROCAR_TRY(room.request, parse_request(a));
  TROCAR_TRY(room.request.tools, read_tools(a.tools));
  TROCAR_TRY(anatomy::VirtualPatient patient, io::open_patient(a.source, progress));
  room.patient = std::make_shared<const anatomy::VirtualPatient>(std::move(patient));
  TROCAR_TRY(room.breathing, cases::breathing_of(*room.patient, a.breathing, a.phase));
  if (a.at.empty()) room.request.arm.isocentre_P = middle_P(room, X_PN);
  if (X_PN) room.request.tools.push_back(needle_of(*X_PN, a.needle_mm));
  core::report(progress, "preparing the X-ray", 0.5);
  TROCAR_TRY(auto volume, xray::XrayVolume::make(room.patient));
  TROCAR_TRY_STATUS(check_beam(*volume, room.request.arm));
  room.fluoroscope.emplace(std::move(volume));
  if (room.injection) {
    core::report(progress, "following the ducts", 0.8);
    TROCAR_TRY_STATUS(prepare_contrast(a, room));
  }
  if (X_PN) warn_of_needle(room, X_PN->p());
  return room;
}

/// Carries the contrast agent on, from `from_s` to `to_s` since the injection began.
Status advance(Room& room, double from_s, double to_s) {
  const double lasts_s = room.injection->ml / room.injection->ml_per_s;
  for (double at_s = from_s; at_s < to_s - 1e-9;) {
    // A step ends where the injection does.
    double next_s = std::min(at_s + kStep_s, to_s);
    if (at_s < lasts_s - 1e-9) next_s = std::min(next_s, lasts_s);
    if (at_s < lasts_s - 1e-9) {
      TROCAR_TRY_STATUS(room.flow->inject(room.injection->place_P, room.injection->ml_per_s, room.iodine_mg_per_ml));
    } else {
      room.flow->stop_injection();
    }
    room.flow->step(next_s - at_s);
    at_s = next_s;
  }
  room.request.iodine = std::make_shared<const xray::Iodine>(room.flow->iodine());
  return {};
}

/// The images: for a subtraction the mask's first, which are not returned. time_s of those with contrast agent is the
/// time since the injection began.
Result<std::vector<xray::FluoroscopyFrame>> make_frames(Room& room, const XrayArguments& a, const Progress& progress) {
  std::vector<xray::FluoroscopyFrame> frames;
  room.request.is_pedal_down = true;
  const int before = room.request.mode == xray::ImageMode::kSubtraction ? kMaskFrames : 0;
  double contrast_s = 0.0;
  const double end_s = a.time_s >= 0.0  ? a.time_s
                       : room.injection ? room.injection->ml / room.injection->ml_per_s
                                        : 0.0;
  for (int n = 0; n < before + a.frames; ++n) {
    core::report(progress, "making images", static_cast<double>(n) / (before + a.frames));
    if (room.injection && n >= before) {
      const double to_s = a.frames > 1 ? end_s * (n - before) / (a.frames - 1) : end_s;
      TROCAR_TRY_STATUS(advance(room, contrast_s, to_s));
      contrast_s = to_s;
    }
    room.request.time_s = n / kPulses_per_s;
    room.request.motion = motion::MotionClock{room.patient->motion.get(), room.breathing}.at(room.request.time_s);
    TROCAR_TRY(auto frame, room.fluoroscope->frame(room.request, a.seed + static_cast<std::uint64_t>(n)));
    if (room.injection && (end_s > 0.0 || a.frames == 1)) frame.time_s = contrast_s;
    if (n >= before) frames.push_back(std::move(frame));
  }
  return frames;
}

/// The attenuation -ln(signal) at the place of the detector, as two equal slices of 1 mm.
Status write_attenuation(const std::vector<float>& signal, const xray::XrayRays& rays, const fs::path& path) {
  volume::GridGeometry geometry;
  geometry.size = {rays.columns, rays.rows, 2};
  geometry.spacing_mm = {rays.column_P.norm(), rays.row_P.norm(), 1.0};
  geometry.R_PV.col(0) = rays.column_P.normalized();
  geometry.R_PV.col(1) = rays.row_P.normalized();
  geometry.R_PV.col(2) = geometry.R_PV.col(0).cross(geometry.R_PV.col(1));
  geometry.origin_P = rays.first_pixel_P;
  volume::FloatGrid slab(geometry);
  for (std::size_t n = 0; n < slab.voxels.size(); ++n)
    slab.voxels[n] = -std::log(std::max(signal[n % signal.size()], 1e-9F));
  return io::write_image(slab, path);
}

dicom::XaImage to_xa(const std::vector<xray::FluoroscopyFrame>& frames) {
  const xray::FluoroscopyFrame& last = frames.back();
  dicom::XaImage image;
  image.columns = last.gray.columns;
  image.rows = last.gray.rows;
  for (const xray::FluoroscopyFrame& frame : frames) {
    image.frames.push_back(frame.gray.pixels);
    if (frames.size() > 1) image.time_s.push_back(frame.time_s - frames.front().time_s);
  }
  const xray::FieldPixels field = xray::field_pixels(last.arm);
  image.shutters = {field.first_column, image.columns - field.last_column, field.first_row,
                    image.rows - field.last_row};
  image.geometry = {last.arm.lao_deg, last.arm.cranial_deg, last.arm.source_detector_mm, last.arm.source_isocentre_mm,
                    last.arm.field_mm / last.arm.pixels};
  constexpr double kPulse_ms = 8.0;  // assumed
  image.exposure = {last.exposure.tube.kv,
                    last.exposure.mas / (1e-3 * kPulse_ms),
                    kPulse_ms,
                    last.exposure.mas * static_cast<double>(frames.size()),
                    last.dose.area_product_mgy_cm2,
                    true};
  return image;
}

Status write_result(const std::vector<xray::FluoroscopyFrame>& frames, const xray::Fluoroscope& fluoroscope,
                    const fs::path& out) {
  if (out.extension() == ".dcm") return dicom::write_xa_file(to_xa(frames), out);
  if (out.extension() == ".nrrd") return write_attenuation(fluoroscope.signal(), xray::rays_of(frames.back().arm), out);
  return png::write_png(to_rgb(frames.back().gray), out);
}

config::Json to_json(const Room& room, const xray::FluoroscopyFrame& frame) {
  const xray::CArm& arm = frame.arm;
  config::Json json{{"lao_deg", arm.lao_deg},
                    {"cranial_deg", arm.cranial_deg},
                    {"isocentre_mm", {arm.isocentre_P.x(), arm.isocentre_P.y(), arm.isocentre_P.z()}},
                    {"field_mm", arm.field_mm},
                    {"magnification", xray::magnification(arm)},
                    {"kv", frame.exposure.tube.kv},
                    {"mas", frame.exposure.mas},
                    {"is_exposure_limited", frame.exposure.is_limited},
                    {"air_kerma_mgy", frame.dose.air_kerma_mgy},
                    {"dose_area_gycm2", 1e-3 * frame.dose.area_product_mgy_cm2},
                    {"contrast", nullptr}};
  if (!room.flow) return json;
  const xray::ContrastTotals totals = room.flow->totals();
  json["contrast"] = {{"time_s", frame.time_s},
                      {"place", xray::contrast_place_words(room.flow->place(room.injection->place_P))},
                      {"injected_ml", totals.injected_ml},
                      {"in_body_mg", totals.in_body_mg()},
                      {"ducts_mg", totals.ducts_mg},
                      {"drained_mg", totals.drained_mg},
                      {"washed_away_mg", totals.washed_away_mg}};
  return json;
}

Status make_xray(const XrayArguments& a) {
  TROCAR_TRY_STATUS(check_xray_output(a));
  TROCAR_TRY_STATUS(check_outputs({a.out}));
  const ProgressPrinter printer;
  TROCAR_TRY(Room room, prepare_room(a, printer.callback()));
  TROCAR_TRY(const auto frames, make_frames(room, a, printer.callback()));
  TROCAR_TRY_STATUS(write_result(frames, *room.fluoroscope, a.out));
  if (a.is_json) {
    config::Json json = to_json(room, frames.back());
    json["out"] = a.out;
    json["frames"] = frames.size();
    print_json(json);
  } else if (room.flow) {
    fmt::print("{:.1f} ml of contrast agent, {}\n", room.flow->totals().injected_ml,
               xray::contrast_place_words(room.flow->place(room.injection->place_P)));
  }
  return {};
}

}  // namespace

void add_xray_command(Command& program, Action& action) {
  Command command = program.add_command("xray", "Create an X-ray image of a patient");
  command.footer(
      "Examples:\n  trocar xray --patient ptcd-1 --out ap.png\n"
      "  trocar xray --patient ptcd-1 --carm -30,10 --needle needle.tfm --out oblique.png\n"
      "  trocar xray --patient ptcd-1 --contrast 10@-36.8,-62.9,16.1 --time 12 --subtract --out ducts.png\n"
      "  trocar xray --patient ptcd-1 --contrast 10@-36.8,-62.9,16.1 --time 12 --frames 30 --out run.dcm\n"
      "  trocar xray --patient ptcd-1 --tools drainage.mrk.json --out drainage.png\n");
  const auto a = std::make_shared<XrayArguments>();
  add_cache_option(command, a->source);
  add_xray_options(command, *a);
  command.when_parsed([&action, a] { action = [a] { return make_xray(*a); }; });
}

}  // namespace trocar::cli
