// trocar ultrasound image: a B-mode image of a patient, and the frame rate.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "bench/figures.h"
#include "cli/breathing_option.h"
#include "cli/commands.h"
#include "cli/constants.h"
#include "cli/ultrasound/doppler.h"
#include "cli/ultrasound/scan.h"
#include "config/json.h"
#include "io/image/image_file.h"
#include "io/patient/patient_extras.h"
#include "io/sequence/transform_file.h"
#include "png/png_file.h"
#include "ultrasound/engine/b_mode.h"
#include "ultrasound/panorama/panorama_engine.h"
#include "ultrasound/scanner/scan_annotation.h"
#include "ultrasound/scanner/scanner.h"
#include "ultrasound/sweep/freehand_sweep.h"

namespace trocar::cli {
namespace {
namespace fs = std::filesystem;

// Engines.
constexpr const char* kRaycast = "raycast";
constexpr const char* kPanorama = "panorama";
constexpr int kMostFrames = 100000;
constexpr double kHardlyAny = 0.01;  ///< Share of the image from the panorama that causes a warning.
/// Range of the needle gauges below.
constexpr int kThickestGauge = 14, kThinnestGauge = 25;
/// Number of frames after which persistence has converged to one or two gray values.
constexpr int kPersistingPictures = 40;

struct ImageArguments {
  ScanArguments scan;
  DopplerArguments doppler;
  std::string needle;
  int needle_gauge = 18;
  std::string engine = kRaycast;
  std::string out;
  std::string size = "640x480";
  int frames = 0;
  bool is_plain = false;
  bool is_unmirrored = false;
  bool is_json = false;
};

/// Outer diameter of a needle, mm (needle gauge comparison chart, Birmingham wire gauge).
double diameter_of_gauge(int gauge) {
  constexpr std::array kDiameters_mm = {2.108, 1.829, 1.651, 1.473, 1.270, 1.067,
                                        0.908, 0.819, 0.718, 0.642, 0.566, 0.515};
  static_assert(kDiameters_mm.size() == kThinnestGauge - kThickestGauge + 1);
  return kDiameters_mm[static_cast<std::size_t>(gauge - kThickestGauge)];
}

struct Size {
  int columns = 0, rows = 0;
};
Result<Size> parse_size(const std::string& text) {
  Size size;
  int read = 0;
  const bool is_read = std::sscanf(text.c_str(), "%5dx%5d%n", &size.columns, &size.rows, &read) == 2 &&
                       static_cast<std::size_t>(read) == text.size();
  if (!is_read || size.columns < 16 || size.rows < 16 || size.columns > 4096 || size.rows > 4096)
    return fail_usage("--size is not COLUMNSxROWS from 16 to 4096", text, "write it as 640x480");
  return size;
}

/// The straight needle of a file; without a file, no shaft.
struct Needle {
  std::vector<Vec3> shaft_P;
  double diameter_mm = 0.0;
};
Result<Needle> load_needle(const ImageArguments& arguments) {
  Needle needle;
  needle.diameter_mm = diameter_of_gauge(arguments.needle_gauge);
  if (arguments.needle.empty()) return needle;
  TROCAR_TRY(const Pose X_PN, io::read_transform(arguments.needle));
  needle.shaft_P = {X_PN * Vec3(0.0, 0.0, -kNeedleLength_mm), X_PN.p()};
  return needle;
}

/// Request of the arguments, checked before any work.
struct Request {
  Size size;
  Needle needle;
  ultrasound::DopplerSettings doppler;
};
Result<Request> check_arguments(const ImageArguments& arguments) {
  const std::string ending = fs::path(arguments.out).extension().string();
  if (ending != ".png" && ending != ".nrrd")
    return fail_usage("the file name must end in .png or .nrrd", arguments.out, "rename the output");
  TROCAR_TRY_STATUS(check_outputs({arguments.out, arguments.scan.save_pose}));
  Request request;
  TROCAR_TRY(request.size, parse_size(arguments.size));
  TROCAR_TRY(request.needle, load_needle(arguments));
  TROCAR_TRY(request.doppler, gather_doppler(arguments.doppler));
  if (arguments.doppler.is_wanted && ending != ".png")
    return fail_usage("colour Doppler cannot be written as .nrrd", arguments.out, "write a .png, or omit --doppler");
  return request;
}

/// The engine of the arguments, with the panorama's own interface if it is that one.
struct Engine {
  std::unique_ptr<ultrasound::EchoEngine> echoes;
  const ultrasound::PanoramaEngine* panorama = nullptr;
};
Engine make_engine(const Scan& scan, std::shared_ptr<const ultrasound::Panorama> panorama) {
  if (!panorama) return {std::make_unique<ultrasound::BMode>(scan.scene, scan.transducer, scan.acquisition), nullptr};
  auto engine =
      std::make_unique<ultrasound::PanoramaEngine>(scan.scene, std::move(panorama), scan.transducer, scan.acquisition);
  const ultrasound::PanoramaEngine* const own = engine.get();
  return {std::move(engine), own};
}

/// The image as a thin volume at the position of its plane in the patient: two equal slices, since readers cannot
/// interpolate within a single slice.
volume::LabelGrid as_slab(const image::GrayImage& picture, const ultrasound::RasterGeometry& raster, const Pose& X_PT) {
  constexpr double kThickness_mm = 1.0;
  const Vec3 along_columns(raster.is_mirrored ? -1.0 : 1.0, 0.0, 0.0);
  Mat3 R_TI;
  R_TI << along_columns, Vec3::UnitY(), along_columns.cross(Vec3::UnitY());
  volume::GridGeometry geometry;
  geometry.size = {picture.columns, picture.rows, 2};
  geometry.spacing_mm = {raster.mm_per_pixel, raster.mm_per_pixel, kThickness_mm};
  geometry.origin_P = X_PT * (Vec3(raster.first_T.x(), raster.first_T.y(), 0.0) - 0.5 * kThickness_mm * R_TI.col(2));
  geometry.R_PV = X_PT.R() * R_TI;
  volume::LabelGrid slab(geometry);
  std::copy(picture.pixels.begin(), picture.pixels.end(), slab.voxels.begin());
  std::copy(picture.pixels.begin(), picture.pixels.end(),
            slab.voxels.begin() + static_cast<std::ptrdiff_t>(picture.pixels.size()));
  return slab;
}

struct Timing {
  double frames_per_s = 0.0;  ///< Of all consecutive frames.
  bench::Figures frame_ms, engine_ms, scanner_ms;
};
Timing time_frames(ultrasound::EchoEngine& engine, ultrasound::Scanner& scanner, const Scan& scan,
                   std::span<const ultrasound::NeedleEcho> needles, int frames, std::uint64_t seed,
                   const Progress& progress) {
  using Clock = std::chrono::steady_clock;
  const auto ms = [](Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double, std::milli>(to - from).count();
  };
  std::vector<double> frame_ms, engine_ms, scanner_ms;
  double whole_ms = 0.0;
  for (int n = 0; n < frames; ++n) {
    core::report(progress, "timing frames", static_cast<double>(n) / frames);
    const auto start = Clock::now();
    const ultrasound::BasebandFrame& echoes = engine.render({.X_PT = ultrasound::sway(scan.X_PT, n),
                                                             .needles = needles,
                                                             .time_s = n / 60.0,
                                                             .motion = motion_at(scan, n / 60.0)});
    const auto heard = Clock::now();
    scanner.show(echoes, seed + static_cast<std::uint64_t>(n));
    const auto shown = Clock::now();
    engine_ms.push_back(ms(start, heard));
    scanner_ms.push_back(ms(heard, shown));
    frame_ms.push_back(ms(start, shown));
    whole_ms += frame_ms.back();
  }
  return {1000.0 * frames / whole_ms, bench::figures_of(frame_ms), bench::figures_of(engine_ms),
          bench::figures_of(scanner_ms)};
}

config::Json to_json(const bench::Figures& figures) {
  const auto number = [](const std::optional<double>& value) {
    return value ? config::Json(*value) : config::Json(nullptr);
  };
  return {{"median", number(figures.median)}, {"p99", number(figures.p99)}, {"max", number(figures.max)}};
}

config::Json to_json(const Timing& timing, int frames) {
  return {{"count", frames},
          {"frames_per_s", timing.frames_per_s},
          {"frame_ms", to_json(timing.frame_ms)},
          {"engine_ms", to_json(timing.engine_ms)},
          {"scanner_ms", to_json(timing.scanner_ms)}};
}

void print_figures(const char* name, const bench::Figures& figures) {
  const std::string tail =
      figures.p99 ? fmt::format("p99 {:.2f}", *figures.p99) : std::string("no p99 below 100 frames");
  fmt::print("  {:<8} median {:.2f} ms, {}, max {:.2f}\n", name, *figures.median, tail, *figures.max);
}

Status write_picture(const ImageArguments& arguments, const Scan& scan, const image::GrayImage& gray,
                     const ultrasound::RasterGeometry& raster, const ultrasound::ScanGeometry& geometry,
                     std::optional<ColourPicture> colour) {
  if (fs::path(arguments.out).extension() == ".nrrd")
    return io::write_image(as_slab(gray, raster, scan.X_PT), arguments.out);
  image::RgbImage picture = colour ? colour->image : image::to_rgb(gray);
  if (!arguments.is_plain) {
    ultrasound::hatch_unscanned(picture, raster, geometry, scan.X_PT, scan.scene->ends);
    ultrasound::ScanCaption caption;
    caption.transducer = scan.transducer.name;
    caption.frequency_mhz = scan.acquisition.frequency_mhz;
    caption.is_harmonic = scan.acquisition.is_harmonic;
    caption.focus_mm = scan.acquisition.focus_mm;
    caption.settings = scan.display;
    if (scan.unscanned_share > 0.0) caption.remarks.emplace_back("Outside CT");
    ultrasound::draw_annotation(picture, ultrasound::make_scan_annotation(raster, geometry, caption));
    if (colour) draw_colour_bar(picture, *colour);
  }
  return png::write_png(picture, arguments.out);
}

Status make_image(const ImageArguments& arguments) {
  TROCAR_TRY(const Request request, check_arguments(arguments));
  const ProgressPrinter printer;
  ScanArguments wanted = arguments.scan;
  wanted.needs_flow = arguments.doppler.is_wanted;
  std::shared_ptr<const ultrasound::Panorama> panorama;
  if (arguments.engine == kPanorama) {
    TROCAR_TRY(panorama, io::load_panorama(wanted.source));
  }
  TROCAR_TRY(Scan scan, prepare_scan(wanted, {}, printer.callback()));
  if (arguments.is_unmirrored) scan.display.is_mirrored = false;

  const Engine made = make_engine(scan, panorama);
  ultrasound::EchoEngine& engine = *made.echoes;
  ultrasound::Scanner scanner(request.size.columns, request.size.rows);
  scanner.settings = scan.display;
  scanner.artefacts = scan.acquisition.artefacts;
  ultrasound::NeedleEcho needle;
  needle.shaft_P = request.needle.shaft_P;
  needle.diameter_mm = request.needle.diameter_mm;
  const std::span<const ultrasound::NeedleEcho> needles(&needle, needle.shaft_P.empty() ? 0 : 1);
  const ultrasound::BasebandFrame& echoes =
      engine.render({.X_PT = scan.X_PT, .needles = needles, .motion = motion_at(scan, 0.0)});
  const double coupled = ultrasound::coupled_share(echoes);
  const double panorama_share = made.panorama != nullptr ? made.panorama->panorama_share() : 0.0;
  const int ray_cast_lines = made.panorama != nullptr ? made.panorama->ray_cast_lines() : 0;
  const int pictures = scan.display.persistence > 0.0 ? kPersistingPictures : 1;
  image::GrayImage picture;
  for (int n = 0; n < pictures; ++n)
    picture = scanner.show(echoes, arguments.scan.seed + static_cast<std::uint64_t>(n));
  const ultrasound::RasterGeometry raster = scanner.raster();
  std::optional<ColourPicture> colour;
  if (scan.flow)
    colour = colour_picture(scan.flow, request.doppler, arguments.doppler.time_s, engine, echoes, scan, picture, raster,
                            arguments.scan.seed);

  Timing timing;
  if (arguments.frames > 0)
    timing = time_frames(engine, scanner, scan, needles, arguments.frames, arguments.scan.seed, printer.callback());
  TROCAR_TRY_STATUS(write_picture(arguments, scan, picture, raster, engine.geometry(), colour));
  if (!arguments.scan.save_pose.empty()) TROCAR_TRY_STATUS(save_pose(scan, arguments.scan.save_pose));

  warn_of_contact(coupled);
  warn_of_visibility(scan);
  if (panorama && panorama_share < kHardlyAny)
    print_warning("the panorama does not cover the image: all of it is ray cast");
  if (arguments.is_json) {
    config::Json json = to_json(scan);
    json["out"] = arguments.out;
    json["engine"] = arguments.engine;
    json["panorama_share"] = panorama ? config::Json(panorama_share) : config::Json(nullptr);
    json["ray_cast_lines"] = panorama ? config::Json(ray_cast_lines) : config::Json(nullptr);
    json["columns"] = picture.columns;
    json["rows"] = picture.rows;
    json["mm_per_pixel"] = raster.mm_per_pixel;
    json["coupled"] = coupled;
    json["doppler_scale_cm_per_s"] = colour ? config::Json(colour->scale_cm_per_s) : config::Json(nullptr);
    json["frames"] = arguments.frames > 0 ? to_json(timing, arguments.frames) : config::Json(nullptr);
    print_json(json);
  } else if (arguments.frames > 0) {
    fmt::print("{:.1f} frames/s over {} frames, the transducer moving\n", timing.frames_per_s, arguments.frames);
    print_figures("frame", timing.frame_ms);
    print_figures("engine", timing.engine_ms);
    print_figures("scanner", timing.scanner_ms);
  }
  return {};
}

}  // namespace

void add_ultrasound_image_command(Command& ultrasound, Action& action) {
  Command command = ultrasound.add_command("image", "Create a B-mode image of a patient");
  command.footer(
      "Examples:\n  trocar ultrasound image --patient abdomen --view liver-right-kidney --out kidney.png\n"
      "  trocar ultrasound image --patient abdomen --view aorta --doppler --doppler-scale 60 --out aorta.png\n"
      "  trocar ultrasound image --patient my_patient --pose probe.tfm --needle needle.tfm --out needle.png\n"
      "  trocar ultrasound image --patient my_patient --pose probe.tfm --engine panorama --out slice.png\n"
      "  trocar ultrasound image --patient abdomen --pose probe.tfm --frames 300 --out frame.png\n");
  const auto a = std::make_shared<ImageArguments>();
  add_scan_options(command, a->scan);
  add_breathing_options(command, a->scan.breathing, a->scan.phase);
  add_doppler_options(command, a->doppler);
  command.add_option("--persistence", a->scan.display.persistence, "Weight of the previous frame (persistence)")
      .number_within(0.0, 0.95, "")
      .show_default();
  command.add_option("--needle", a->needle,
                     "X_PN: transform from the needle (tip at 0, +z towards the tip) to the patient (.tfm)");
  command.add_option("--needle-gauge", a->needle_gauge, "Outer diameter of the needle, gauge")
      .whole_number_within(kThickestGauge, kThinnestGauge)
      .show_default();
  command
      .add_option("--engine", a->engine,
                  "raycast (from CT and labels) or panorama (from the stitched volumes in the patient folder)")
      .one_of({kRaycast, kPanorama})
      .show_default();
  command
      .add_option("--out", a->out,
                  "Output: .png, or .nrrd as a thin slab at the position of the image plane in the patient")
      .required();
  command.add_option("--size", a->size, "Size of the image, COLUMNSxROWS, 16 to 4096 each").show_default();
  command.add_option("--frames", a->frames, "Benchmark: render N more frames with a moving transducer")
      .whole_number_within(1, kMostFrames);
  command.add_flag("--plain", a->is_plain, "Omit scale, marker and settings around the image");
  command.add_flag("--unmirrored", a->is_unmirrored,
                   "Show +x of the transducer (head, or the patient's right) on the right");
  command.add_flag("--json", a->is_json, "Print one JSON object");
  command.when_parsed([&action, a] { action = [a] { return make_image(*a); }; });
}

}  // namespace trocar::cli
