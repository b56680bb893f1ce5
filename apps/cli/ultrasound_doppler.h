#pragma once

#include <CLI/App.hpp>
#include <memory>
#include <string>
#include <vector>

#include "output.h"
#include "ultrasound/doppler/colour_doppler.h"
#include "ultrasound/engine/b_mode.h"

namespace trocar::cli {

/// What commands that show flow in colour ask for.
struct DopplerArguments {
  bool is_wanted = false;
  ultrasound::DopplerSettings settings;
  std::vector<double> box;  ///< Empty, or first, last of the width, near, far of the depth, percent.
  double time_s = 0.17;     ///< Since the R wave: systole.
};
void add_doppler_options(CLI::App& command, DopplerArguments& arguments);

/// The settings, or what is wrong in them.
Result<ultrasound::DopplerSettings> gather_doppler(const DopplerArguments& arguments);

/// The picture with colours, as they have settled after some pulses of one moment.
struct ColourPicture {
  volume::RgbImage image;
  ultrasound::DopplerSettings settings;
  double scale_cm_per_s = 0.0;  ///< In use.
};
/// `engine` has rendered that frame, `picture` is its.
ColourPicture colour_picture(std::shared_ptr<const ultrasound::VesselFlow> flow,
                             const ultrasound::DopplerSettings& settings, double time_s,
                             const ultrasound::BMode& engine, const ultrasound::BasebandFrame& echoes, const Pose& X_PT,
                             const ultrasound::GrayImage& picture, const ultrasound::RasterGeometry& raster,
                             std::uint64_t seed);
/// The colour bar, beside the gray wedge.
void draw_colour_bar(volume::RgbImage& image, const ColourPicture& picture);

}  // namespace trocar::cli
