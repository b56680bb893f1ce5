#include "ultrasound/sweep/mechanical_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "core/random.h"
#include "core/result.h"
#include "ultrasound/scanner/scanner.h"
#include "ultrasound/sweep/detail/limits.h"
#include "volume/sampling.h"

namespace trocar::ultrasound {
namespace {

using detail::is_within;

constexpr double kMaxSweepSamples = 1e9;  ///< One byte each.
constexpr double kLeastSweep_rad = 0.01;
constexpr int kMostFrames = 1000;
/// The scanner's image is not used, only the gray levels per scanline.
constexpr int kNoColumns = 16;

/// Frames one after another, scanline by scanline.
struct Frames {
  std::vector<std::uint8_t> gray;
  double mean_contact = 0.0;
};

/// Samples are finer than voxels: a voxel gets the mean of the samples along its length.
void average_along_lines(const std::vector<std::uint8_t>& polar, int samples, int half_length, std::uint8_t* out) {
  const std::size_t n = static_cast<std::size_t>(samples);
  for (std::size_t line = 0; line < polar.size() / n; ++line) {
    const std::uint8_t* const in = polar.data() + line * n;
    for (int s = 0; s < samples; ++s) {
      const int first = std::max(s - half_length, 0), last = std::min(s + half_length, samples - 1);
      int sum = 0;
      for (int at = first; at <= last; ++at) sum += in[at];
      const int count = last - first + 1;
      out[line * n + static_cast<std::size_t>(s)] = static_cast<std::uint8_t>((sum + count / 2) / count);
    }
  }
}

Frames take_frames(const std::shared_ptr<const AcousticScene>& scene, const Transducer& transducer, const Pose& X_PT,
                   const SweepGeometry& geometry, const MechanicalSweepOptions& options, const Progress& progress) {
  BMode engine(scene, transducer, options.acquisition);
  Scanner scanner(kNoColumns, 1);
  scanner.settings = options.display;
  scanner.settings.persistence = 0.0;
  scanner.artefacts = options.acquisition.artefacts;
  Frames frames;
  const std::size_t frame_size =
      static_cast<std::size_t>(geometry.scan.lines) * static_cast<std::size_t>(geometry.scan.samples);
  const auto half_length = static_cast<int>(std::lround(0.5 * options.spacing_mm / geometry.scan.sample_mm() - 0.5));
  frames.gray.resize(frame_size * static_cast<std::size_t>(geometry.frames));
  for (int n = 0; n < geometry.frames; ++n) {
    report(progress, "swinging the array", 0.8 * n / geometry.frames);
    const BasebandFrame& echoes = engine.render({X_PT * geometry.frame_pose(n), {}, 0.0});
    frames.mean_contact += coupled_share(echoes) / geometry.frames;
    scanner.show(echoes, mix64(mix64(options.seed) ^ static_cast<std::uint64_t>(n)));
    average_along_lines(scanner.polar(), geometry.scan.samples, half_length,
                        frames.gray.data() + frame_size * static_cast<std::size_t>(n));
  }
  return frames;
}

/// false beyond half a sample outside.
bool find_neighbours(double at, int count, volume::Neighbours& found) {
  if (!(at > -0.5 && at < count - 0.5)) return false;
  found = volume::neighbours(at, count);
  return true;
}

/// Gray of a voxel without echoes: 0 means that a voxel was not imaged.
constexpr long kDarkest = 1;

/// Trilinear between frames, scanlines and samples.
std::uint8_t gray_at(const Frames& frames, const SweepGeometry& geometry, const Vec3& p_T) {
  const SweepGeometry::Place place = geometry.to_place(p_T);
  volume::Neighbours frame, line, sample;
  const double depth_samples = place.polar.depth_mm / geometry.scan.sample_mm() - 0.5;
  if (!find_neighbours(place.frame, geometry.frames, frame) ||
      !find_neighbours(place.polar.line, geometry.scan.lines, line) ||
      !find_neighbours(depth_samples, geometry.scan.samples, sample))
    return 0;
  const auto between = [](const volume::Neighbours& n, const auto& value) {
    return std::lerp(static_cast<float>(value(n.low)), static_cast<float>(value(n.high)), static_cast<float>(n.share));
  };
  const float value = between(frame, [&](std::int64_t f) {
    return between(line, [&](std::int64_t l) {
      const std::int64_t begin = (f * geometry.scan.lines + l) * geometry.scan.samples;
      return between(sample, [&](std::int64_t s) { return frames.gray[static_cast<std::size_t>(begin + s)]; });
    });
  });
  return static_cast<std::uint8_t>(std::max(std::lround(value), kDarkest));
}

Result<SweepGeometry> plan_sweep(const Transducer& transducer, const MechanicalSweepOptions& options) {
  if (transducer.kind != TransducerKind::kMechanicalConvex)
    return fail_usage("the transducer has no motor", transducer.name, "choose a mechanical one");
  SweepGeometry geometry;
  const Acquisition& acquisition = options.acquisition;
  geometry.scan = make_scan_geometry(transducer, acquisition.depth_mm, acquisition.lines, acquisition.samples);
  geometry.radius_mm = transducer.sweep_radius_mm;
  geometry.sweep_rad = options.sweep_rad == 0.0 ? transducer.sweep_rad : options.sweep_rad;
  if (!is_within(geometry.sweep_rad, kLeastSweep_rad, std::numbers::pi / 2.0))
    return fail_usage("the sweep's angle is not within 0.6..90 degrees", transducer.name,
                      "give an angle in this range");
  const double steps = std::ceil(geometry.sweep_rad / options.step_rad);
  if (!is_within(steps, 1.0, kMostFrames - 1))
    return fail_usage(fmt::format("the sweep would have {:.0f} frames", steps + 1.0), transducer.name,
                      fmt::format("choose a step with at most {}", kMostFrames));
  geometry.frames = std::max(2, static_cast<int>(steps) + 1);
  if (static_cast<double>(geometry.frames) * acquisition.lines * acquisition.samples > kMaxSweepSamples)
    return fail_usage("the frames would have more than a thousand million samples", transducer.name,
                      "choose fewer scanlines or samples");
  return geometry;
}

/// A grid in T with a plane of voxels in the middle frame.
Result<volume::GridGeometry> lay_grid(const SweepGeometry& geometry, double spacing_mm) {
  if (!is_within(spacing_mm, 0.2, 5.0))
    return fail_usage(fmt::format("a spacing of {} mm is not within 0.2..5", spacing_mm), "spacing",
                      "give a spacing in this range");
  const SweepGeometry::Extent extent = geometry.extent();
  volume::GridGeometry grid;
  grid.spacing_mm = Vec3::Constant(spacing_mm);
  double voxels = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double first = std::floor(extent.first_T[axis] / spacing_mm);
    const double count = std::ceil(extent.last_T[axis] / spacing_mm) - first + 1.0;
    grid.origin_P[axis] = first * spacing_mm;
    grid.size[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(count);
    voxels *= count;
  }
  if (voxels > detail::kMaxVoxels)
    return fail_usage(fmt::format("the volume would have {:.0f} million voxels", voxels * 1e-6), {},
                      "choose a larger spacing");
  return grid;
}

}  // namespace

Pose SweepGeometry::frame_pose(double frame) const noexcept {
  const double angle_rad = frame_angle_rad(frame);
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  Mat3 R;
  R << 1, 0, 0, 0, c, -s, 0, s, c;
  return {R, {0.0, radius_mm * (c - 1.0), radius_mm * s}};
}

Vec3 SweepGeometry::to_cartesian(const Place& place) const noexcept {
  const Vec2 p = scan.to_cartesian(place.polar);
  return frame_pose(place.frame) * Vec3(p.x(), p.y(), 0.0);
}

SweepGeometry::Place SweepGeometry::to_place(const Vec3& p_T) const noexcept {
  const double above_axis = p_T.y() + radius_mm;
  const double angle_rad = std::atan2(p_T.z(), above_axis);
  const double y = std::hypot(above_axis, p_T.z()) - radius_mm;
  return {(angle_rad / sweep_rad + 0.5) * (frames - 1), scan.to_polar({p_T.x(), y})};
}

SweepGeometry::Extent SweepGeometry::extent() const noexcept {
  const ScanGeometry::Extent plane = scan.extent();
  const double half = 0.5 * sweep_rad;
  const double far_mm = plane.y1 + radius_mm;
  const double near_mm = plane.y0 + radius_mm;  // can be behind the axis if the face is strongly curved
  const double lowest = std::min(near_mm * std::cos(half), near_mm) - radius_mm;
  const double widest = std::max(far_mm, std::abs(near_mm)) * std::sin(half);
  return {{plane.x0, lowest, -widest}, {plane.x1, plane.y1, widest}};
}

Result<SweepVolume> make_mechanical_sweep(const std::shared_ptr<const AcousticScene>& scene,
                                          const Transducer& transducer, const Pose& X_PT,
                                          const MechanicalSweepOptions& options, const Progress& progress) {
  SweepVolume volume;
  TROCAR_TRY(volume.geometry, plan_sweep(transducer, options));
  TROCAR_TRY(const volume::GridGeometry grid, lay_grid(volume.geometry, options.spacing_mm));
  const Frames frames = take_frames(scene, transducer, X_PT, volume.geometry, options, progress);
  volume.mean_contact = frames.mean_contact;
  report(progress, "combining the frames into a volume", 0.8);
  volume.gray = volume::LabelGrid(grid);
  const auto row = static_cast<std::size_t>(grid.size[0]);
  parallel_for(volume.gray.voxels.size() / row, 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first * row; n < last * row; ++n) {
      const volume::Index3 ijk = grid.index_of(n);
      const Vec3 index = volume::to_vec3(ijk);
      volume.gray.voxels[n] = gray_at(frames, volume.geometry, grid.to_mm(index));
    }
  });
  report(progress, "done", 1.0);
  return volume;
}

volume::LabelGrid in_patient(const SweepVolume& volume, const Pose& X_PT) {
  volume::LabelGrid grid = volume.gray;
  grid.geometry.origin_P = X_PT * volume.gray.geometry.origin_P;
  grid.geometry.R_PV = X_PT.R() * volume.gray.geometry.R_PV;
  return grid;
}

}  // namespace trocar::ultrasound
