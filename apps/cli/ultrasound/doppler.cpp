#include "cli/ultrasound/doppler.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "motion/patient_motion.h"

namespace trocar::cli {
namespace {

constexpr double kPercent = 0.01;
/// Number of frames after which persistence has reached its final value.
constexpr int kPictures = 12;

/// Position of the colour bar, in dots: right of the gray wedge.
constexpr int kBarColumn = 18;
constexpr int kBarColumns = 10;

}  // namespace

void add_doppler_options(Command& command, DopplerArguments& a) {
  ultrasound::DopplerSettings& s = a.settings;
  command.add_flag("--doppler", a.is_wanted, "Show flow in the labelled vessels as colour Doppler");
  command.add_option("--doppler-scale", s.scale_cm_per_s, "Velocity at the ends of the colour bar")
      .number_within(2.0, 200.0, "cm/s")
      .show_default();
  command
      .add_option("--doppler-box", a.box,
                  "Colour box in percent of width and depth: first,last,near,far, as 20,80,20,90")
      .number_within(0.0, 100.0, "%")
      .separated_by(',')
      .one_value_each();
  command.add_option("--doppler-gain-db", s.gain_db, "Colour gain").number_within(-40.0, 40.0, "dB").show_default();
  command.add_option("--doppler-filter", s.wall_filter, "Wall filter cutoff, as a fraction of the scale")
      .number_within(0.0, 0.6, "")
      .show_default();
  command.add_option("--doppler-mhz", s.frequency_mhz, "Frequency of the Doppler pulses")
      .number_within(1.0, 15.0, "MHz")
      .show_default();
  command.add_option("--doppler-baseline", s.baseline, "Baseline shift, as a fraction of the scale")
      .number_within(-0.9, 0.9, "")
      .show_default();
  command.add_flag("--doppler-invert", s.is_inverted, "Invert the colours: blue is flow towards the transducer");
  command.add_option("--time-s", a.time_s, "Seconds since the last R wave (cardiac phase for Doppler)")
      .number_within(0.0, 3600.0, "s")
      .show_default();
}

Result<ultrasound::DopplerSettings> gather_doppler(const DopplerArguments& a) {
  ultrasound::DopplerSettings settings = a.settings;
  if (!a.box.empty()) {
    if (a.box.size() != 4 || !(a.box[0] < a.box[1] && a.box[2] < a.box[3]))
      return fail_usage(fmt::format("--doppler-box is {}", fmt::join(a.box, ",")), {},
                        "give first,last,near,far in percent, first below last and near below far, as 20,80,20,90");
    settings.box = {kPercent * a.box[0], kPercent * a.box[1], kPercent * a.box[2], kPercent * a.box[3]};
  }
  TROCAR_TRY_STATUS(check(settings));
  return settings;
}

ColourPicture colour_picture(std::shared_ptr<const ultrasound::VesselFlow> flow,
                             const ultrasound::DopplerSettings& settings, double time_s,
                             const ultrasound::EchoEngine& engine, const ultrasound::BasebandFrame& echoes,
                             const Scan& scan, const image::GrayImage& picture,
                             const ultrasound::RasterGeometry& raster, std::uint64_t seed) {
  ultrasound::ColourDoppler doppler(std::move(flow));
  doppler.settings = settings;
  ColourPicture colour;
  colour.settings = settings;
  ultrasound::DopplerInput input{scan.X_PT, echoes.geometry,        echoes.beam, time_s, seed,
                                 &engine,   motion_at(scan, time_s)};
  for (int n = 0; n < kPictures; ++n, ++input.seed) colour.scale_cm_per_s = doppler.render(input).scale_cm_per_s;
  colour.image = doppler.overlay(picture, raster);
  return colour;
}

void draw_colour_bar(image::RgbImage& image, const ColourPicture& picture) {
  constexpr int kColumnsPerScale = 640;
  const int dot = std::max(1, image.columns / kColumnsPerScale);
  const int rows = image.rows / 4;
  ultrasound::draw_colour_bar(image, kBarColumn * dot, (image.rows - rows) / 2, kBarColumns * dot, rows,
                              picture.scale_cm_per_s, picture.settings);
}

}  // namespace trocar::cli
