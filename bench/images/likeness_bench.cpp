// Similarity of simulated images to a recorded sweep of a liver: gray levels, level against depth, speckle size; and a
// comparison image.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bench/benchmarks.h"
#include "core/files/folders.h"
#include "io/sequence/sequence_file.h"
#include "lab/ultrasound/picture_figures.h"
#include "phantom/phantom.h"
#include "png/png_file.h"
#include "ultrasound/engine/b_mode.h"
#include "ultrasound/probe/probe_placement.h"
#include "ultrasound/scanner/scanner.h"

namespace trocar::bench {
namespace {

constexpr const char* kTransducer = "liver-sweep";
constexpr const char* kLiverView = "diaphragm";
/// Geometry of the recorded images (739 x 593 pixels): pixel size, and the pixel at the centre of the face; fitted to
/// the edges of the fan.
constexpr double kRecordedPixel_mm = 0.3148;
constexpr double kFaceColumn = 369.6, kFaceRow = 22.3;
constexpr int kRecordedColumns = 739, kRecordedRows = 593;
constexpr std::size_t kEvery = 10;  ///< Interval of the measured frames of the recording.
constexpr int kSimulated = 14;      ///< Number of frames.
constexpr double kSweep_mm = 40.0;  ///< Along elevation.

struct Pictures {
  ultrasound::PictureFigures figures;
  image::RgbImage shown;  ///< One of the images.
};

image::RgbImage rgb_of(std::span<const std::uint8_t> grays, int columns, int rows) {
  image::RgbImage image(columns, rows);
  for (std::size_t i = 0; i < grays.size(); ++i) image.pixels[i] = {grays[i], grays[i], grays[i]};
  return image;
}

image::RgbImage side_by_side(const image::RgbImage& a, const image::RgbImage& b) {
  constexpr int kGap = 8;
  image::RgbImage both(a.columns + kGap + b.columns, std::max(a.rows, b.rows), {60, 60, 60});
  for (int row = 0; row < a.rows; ++row)
    for (int column = 0; column < a.columns; ++column) both.at(column, row) = a.at(column, row);
  for (int row = 0; row < b.rows; ++row)
    for (int column = 0; column < b.columns; ++column) both.at(a.columns + kGap + column, row) = b.at(column, row);
  return both;
}

Result<Pictures> recorded(const std::filesystem::path& path, const ultrasound::Transducer& transducer) {
  TROCAR_TRY(const ultrasound::TrackedSequence sequence, io::read_sequence(path));
  if (sequence.columns != kRecordedColumns || sequence.rows != kRecordedRows)
    return fail_usage("the pictures are not those of the public liver sweep", path.string(),
                      fmt::format("expected {} x {} pixels", kRecordedColumns, kRecordedRows));
  ultrasound::FanPicture picture;
  picture.scan = ultrasound::make_scan_geometry(transducer, transducer.depth_mm, transducer.scanlines, 1024);
  picture.raster = {kRecordedColumns, kRecordedRows, kRecordedPixel_mm,
                    kRecordedPixel_mm * ultrasound::Vec2(-kFaceColumn, -kFaceRow), false};
  const auto size = static_cast<std::size_t>(kRecordedColumns) * static_cast<std::size_t>(kRecordedRows);
  ultrasound::PictureStatistics statistics;
  Pictures pictures;
  for (std::size_t frame = 0; frame < sequence.frames.size(); frame += kEvery) {
    picture.pixels = std::span(sequence.pixels).subspan(frame * size, size);
    statistics.add(picture);
    if (frame <= sequence.frames.size() / 3) pictures.shown = rgb_of(picture.pixels, kRecordedColumns, kRecordedRows);
  }
  pictures.figures = statistics.figures();
  return pictures;
}

Result<Pictures> simulated(const anatomy::VirtualPatient& patient, const ultrasound::Transducer& transducer,
                           const Options& options) {
  TROCAR_TRY(ultrasound::AcousticTable table, ultrasound::load_acoustic_table(data_dir() / "acoustics.toml"));
  TROCAR_TRY(const auto scene, ultrasound::make_acoustic_scene(patient, std::move(table), {}, options.progress));
  ultrasound::BMode engine(scene, transducer, ultrasound::default_acquisition(transducer));
  TROCAR_TRY(const auto views, ultrasound::load_probe_views(data_dir() / "views.toml"));
  TROCAR_TRY(const ultrasound::ProbeView chosen, ultrasound::choose_view(patient, views, kLiverView));
  TROCAR_TRY(const ultrasound::ProbePlacement placed, ultrasound::place_probe(patient, chosen, transducer));
  ultrasound::Scanner scanner(kRecordedColumns, kRecordedRows);
  ultrasound::PictureStatistics statistics;
  Pictures pictures;
  for (int frame = 0; frame < kSimulated; ++frame) {
    const double along_mm = kSweep_mm * (static_cast<double>(frame) / (kSimulated - 1) - 0.5);
    const Pose X_PT = placed.X_PT * Pose::translation(Vec3(0.0, 0.0, along_mm));
    const image::GrayImage& shown = scanner.show(engine.render({X_PT, {}, 0.0}), static_cast<std::uint64_t>(frame));
    statistics.add({scanner.raster(), engine.geometry(), shown.pixels});
    if (frame == kSimulated / 2) pictures.shown = rgb_of(shown.pixels, shown.columns, shown.rows);
  }
  pictures.figures = statistics.figures();
  return pictures;
}

void add_cases(std::vector<CaseResult>& results, const std::string& name, const ultrasound::PictureFigures& figures) {
  const auto add = [&](const std::string& what, const std::string& unit, double value) {
    results.push_back({fmt::format("likeness/{}/{}", name, what), unit, figure_of(value), {}, ""});
  };
  for (const int percent : {10, 25, 50, 75, 90, 99})
    add(fmt::format("gray-p{}", percent), "gray", ultrasound::gray_percentile(figures.histogram, percent / 100.0));
  add("gray-mean", "gray", ultrasound::mean_gray(figures.histogram));
  add("organ-skewness", "ratio", figures.texture.skewness);
  add("organ-kurtosis", "ratio", figures.texture.kurtosis);
  add("organ-bright-permille", "n", figures.texture.bright_permille);
  add("border-above", "gray", figures.border.above_gray);
  add("border-thickness", "mm", figures.border.thickness_mm);
  for (const auto& level : figures.levels) add(fmt::format("level-{:.0f}mm", level.depth_mm), "gray", level.mean);
  for (const auto& speckle : figures.speckle) {
    const auto at = fmt::format("{:.0f}mm", speckle.depth_mm);
    add("patch-gray-" + at, "gray", speckle.mean);
    add("patch-sd-" + at, "gray", speckle.standard_deviation);
    add("axial-" + at, "mm", speckle.axial_fwhm_mm);
    add("lateral-" + at, "mm", speckle.lateral_fwhm_mm);
  }
}

const ultrasound::PictureFigures::Speckle* speckle_at(const ultrasound::PictureFigures& figures, double depth_mm) {
  for (const auto& speckle : figures.speckle)
    if (std::abs(speckle.depth_mm - depth_mm) < 1.0) return &speckle;
  return nullptr;
}

/// Prints recorded and simulated values in two columns.
std::string table_of(const ultrasound::PictureFigures& real, const ultrasound::PictureFigures& simulated) {
  std::string text = fmt::format("\ngray percentiles (recorded | simulated)\n");
  for (const int percent : {5, 10, 25, 50, 75, 90, 95, 99})
    text +=
        fmt::format("  {:>3} % {:>5} | {:>3}\n", percent, ultrasound::gray_percentile(real.histogram, percent / 100.0),
                    ultrasound::gray_percentile(simulated.histogram, percent / 100.0));
  text +=
      fmt::format("  mean {:.1f} | {:.1f}; earth mover's distance {:.1f} gray values per pixel, Bhattacharyya {:.3f}\n",
                  ultrasound::mean_gray(real.histogram), ultrasound::mean_gray(simulated.histogram),
                  ultrasound::earth_mover_distance(real.histogram, simulated.histogram),
                  ultrasound::bhattacharyya_distance(real.histogram, simulated.histogram));
  text += "\ndepth mm: gray mean/median/p99 (recorded | simulated)\n";
  for (std::size_t i = 0; i < std::min(real.levels.size(), simulated.levels.size()); ++i)
    text += fmt::format("  {:>4.0f}  {:>5.1f} {:>3.0f} {:>3.0f} | {:>5.1f} {:>3.0f} {:>3.0f}\n",
                        real.levels[i].depth_mm, real.levels[i].mean, real.levels[i].median, real.levels[i].p99,
                        simulated.levels[i].mean, simulated.levels[i].median, simulated.levels[i].p99);
  text += "\ndepth mm: homogeneous patches, gray mean/sd/skewness, axial and lateral FWHM mm (recorded | simulated)\n";
  for (double depth_mm = 35.0; depth_mm < 180.0; depth_mm += 10.0) {
    const auto* a = speckle_at(real, depth_mm);
    const auto* b = speckle_at(simulated, depth_mm);
    if (a == nullptr && b == nullptr) continue;
    const auto cells = [](const ultrasound::PictureFigures::Speckle* s) {
      if (s == nullptr) return fmt::format("{:>32}", "-");
      return fmt::format("{:>5.1f} {:>5.1f} {:>5.2f}  {:>5.2f} {:>5.2f} {:>4}", s->mean, s->standard_deviation,
                         s->skewness, s->axial_fwhm_mm, s->lateral_fwhm_mm, s->patches);
    };
    text += fmt::format("  {:>4.0f}  {} | {}\n", depth_mm, cells(a), cells(b));
  }
  const auto more = [](const ultrasound::PictureFigures& f) {
    return fmt::format("{:.2f} {:.2f} {:.2f}", f.texture.skewness, f.texture.kurtosis, f.texture.bright_permille);
  };
  text += fmt::format("\norgan at 40 to 100 mm: skewness, kurtosis, permille beyond 4 sd: {} | {}\n", more(real),
                      more(simulated));
  const auto edge = [](const ultrasound::PictureFigures& f) {
    return fmt::format("{:.0f} gray above, {:.1f} mm thick ({} scanlines)", f.border.above_gray, f.border.thickness_mm,
                       f.border.scanlines);
  };
  text += fmt::format("brightest border at 25 to 45 degrees: {} | {}\n", edge(real), edge(simulated));
  return text + "\n";
}

Status write_pictures(const std::filesystem::path& folder, const std::optional<Pictures>& real,
                      const Pictures& synthetic) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail("the folder could not be made", folder.string(), error.message());
  const image::RgbImage image = real ? side_by_side(real->shown, synthetic.shown) : synthetic.shown;
  return png::write_png(image, folder / "likeness.png");
}

}  // namespace

Result<std::vector<CaseResult>> run_likeness_benchmark(const Options& options) {
  TROCAR_TRY(const ultrasound::Transducer transducer,
             ultrasound::load_transducer(data_dir() / "transducers.toml", kTransducer));
  std::optional<Pictures> real;
  if (!options.sequence.empty()) {
    TROCAR_TRY(real, recorded(options.sequence, transducer));
  }
  TROCAR_TRY(const auto patient, patient_of(options));
  TROCAR_TRY(const Pictures synthetic, simulated(*patient, transducer, options));
  std::vector<CaseResult> results;
  if (real) add_cases(results, "recorded", real->figures);
  add_cases(results, patient->name, synthetic.figures);
  if (real) {
    const double moved = ultrasound::earth_mover_distance(real->figures.histogram, synthetic.figures.histogram);
    results.push_back(
        {"likeness/histogram-moved", "gray", figure_of(moved), {}, "gray levels a pixel, earth mover's distance"});
    if (options.print) options.print(table_of(real->figures, synthetic.figures));
  }
  if (!options.out.empty()) TROCAR_TRY_STATUS(write_pictures(options.out, real, synthetic));
  return results;
}

}  // namespace trocar::bench
