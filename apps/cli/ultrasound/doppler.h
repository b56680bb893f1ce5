#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/action.h"
#include "cli/output.h"
#include "cli/ultrasound/scan.h"
#include "ultrasound/doppler/colour_doppler.h"
#include "ultrasound/engine/echo_engine.h"

namespace trocar::cli {

/// Arguments of commands that display colour Doppler.
struct DopplerArguments {
  bool is_wanted = false;
  ultrasound::DopplerSettings settings;
  std::vector<double> box;  ///< Empty, or first and last of the width, near and far of the depth, percent.
  double time_s = 0.17;     ///< Time after the R wave: systole.
};
void add_doppler_options(Command& command, DopplerArguments& arguments);

/// The settings, or an error.
Result<ultrasound::DopplerSettings> gather_doppler(const DopplerArguments& arguments);

/// The image with colours, in the steady state after some pulses at one time.
struct ColourPicture {
  image::RgbImage image;
  ultrasound::DopplerSettings settings;
  double scale_cm_per_s = 0.0;  ///< Scale in use.
};
/// Requires that `engine` has rendered that frame; `picture` is its image.
ColourPicture colour_picture(std::shared_ptr<const ultrasound::VesselFlow> flow,
                             const ultrasound::DopplerSettings& settings, double time_s,
                             const ultrasound::EchoEngine& engine, const ultrasound::BasebandFrame& echoes,
                             const Scan& scan, const image::GrayImage& picture,
                             const ultrasound::RasterGeometry& raster, std::uint64_t seed);
/// Draws the colour bar beside the gray wedge.
void draw_colour_bar(image::RgbImage& image, const ColourPicture& picture);

}  // namespace trocar::cli
