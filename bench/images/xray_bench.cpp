// X-ray projections: plastimatch's DRR of the same CT and geometry, the polyenergetic signal, a turning C-arm; then the
// cases of fluoroscopy and of contrast agent.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "bench/benchmarks.h"
#include "bench/images/xray_contrast_bench.h"
#include "bench/images/xray_fluoroscopy_bench.h"
#include "bench/real_data.h"
#include "core/files/folders.h"
#include "io/image/image_file.h"
#include "phantom/phantom.h"
#include "xray/physics/beam.h"
#include "xray/physics/materials.h"
#include "xray/projection/xray_volume.h"

namespace trocar::bench {
namespace {
namespace fs = std::filesystem;

constexpr int kCtSide = 256;         ///< Voxels along each axis of the volume.
constexpr int kImagePixels = 512;    ///< Pixels along each side of an image.
constexpr int kImagesPerRound = 20;  ///< Images of ours per round.
constexpr int kTurningFrames = 200;  ///< Frames of the turning C-arm.
constexpr double kCt_kev = 70.0;
constexpr double kLeastCorrelation = 0.999;
static_assert(std::endian::native == std::endian::little, "PFM files of plastimatch are little-endian");

struct View {
  const char* name;
  xray::CArm arm;
};

std::vector<View> views(const Vec3& isocentre_P) {
  const auto at = [&](double lao, double cranial) {
    xray::CArm arm;
    arm.lao_deg = lao;
    arm.cranial_deg = cranial;
    arm.isocentre_P = isocentre_P;
    arm.field_mm = 400.0;
    arm.pixels = kImagePixels;
    return arm;
  };
  return {{"", at(0.0, 0.0)},
          {"-lao-30", at(30.0, 0.0)},
          {"-lao-45-cranial-25", at(45.0, 25.0)},
          {"-lateral", at(90.0, 0.0)}};
}

Vec3 middle_P(const volume::GridGeometry& g) {
  return g.to_mm(0.5 * (volume::to_vec3(g.size) - Vec3::Ones()));
}

/// The CT as attenuation relative to water, in thousandths: plastimatch's own conversion leaves out inflated lung.
volume::CtGrid attenuation_of(volume::CtGrid ct) {
  constexpr int kAir_hu = -950;  // as XrayVolume
  for (std::int16_t& v : ct.voxels) v = static_cast<std::int16_t>(v < kAir_hu ? 0 : v + 1000);
  return ct;
}

struct PeerImage {
  std::vector<float> pixels;
  double ms = 0.0;
};

/// Value of a line "NAME: 1.5 secs" of plastimatch's output, summed over such lines.
double seconds_of(const std::string& text, const std::string& name) {
  double sum = 0.0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(name)) sum += std::strtod(line.c_str() + name.size(), nullptr);
  return sum;
}

/// An image of plastimatch's exact algorithm, on all cores. The time is the one that it prints without reading the CT,
/// converting it and writing the image ("Total time" less "I/O time").
Result<PeerImage> run_plastimatch(const fs::path& ct, const xray::CArm& arm, const fs::path& folder) {
  const Vec3 towards = xray::towards_detector_P(arm);
  const xray::XrayRays rays = xray::rays_of(arm);
  const Vec3 up = -rays.row_P.normalized(), source = -towards;  // its normal points to the source
  const auto words = [](const Vec3& v) { return fmt::format("'{:.9f} {:.9f} {:.9f}'", v.x(), v.y(), v.z()); };
  const std::string command = fmt::format(
      "plastimatch drr -t pfm -i exact -P none -r '{0} {0}' -z '{1} {1}' --sad {2} --sid {3} -o {4} -n {5} --vup {6} "
      "-O '{7}' "
      "'{8}' > '{7}.log'",
      arm.pixels, arm.field_mm, arm.source_isocentre_mm, arm.source_detector_mm, words(arm.isocentre_P), words(source),
      words(up), (folder / "peer").string(), ct.string());
  TROCAR_TRY_STATUS(run_quietly({"sh", "-c", command}));
  std::ifstream log(folder / "peer.log");
  const std::string text((std::istreambuf_iterator<char>(log)), {});
  std::ifstream file(folder / "peer0000.pfm", std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  PeerImage image;
  image.pixels.resize(static_cast<std::size_t>(arm.pixels) * static_cast<std::size_t>(arm.pixels));
  const std::size_t payload = image.pixels.size() * sizeof(float);
  if (bytes.size() <= payload)
    return fail("plastimatch wrote no image", (folder / "peer0000.pfm").string(), "run it by hand to see why");
  std::memcpy(image.pixels.data(), bytes.data() + (bytes.size() - payload), payload);
  // It looks from the source's side: its columns run the other way.
  for (int row = 0; row < arm.pixels; ++row) {
    const auto first = image.pixels.begin() + static_cast<std::ptrdiff_t>(row) * arm.pixels;
    std::reverse(first, first + arm.pixels);
  }
  image.ms = 1e3 * (seconds_of(text, "Total time:") - seconds_of(text, "I/O time:"));
  return image;
}

/// Attenuation along each ray at the CT's energy: what a DRR without a spectrum shows.
std::vector<float> attenuation_of(const xray::MassImage& masses) {
  const auto water =
      static_cast<float>(xray::attenuation_cm2_per_g(xray::composition_of(xray::Basis::kWater), kCt_kev));
  const auto bone = static_cast<float>(xray::attenuation_cm2_per_g(xray::composition_of(xray::Basis::kBone), kCt_kev));
  std::vector<float> image(masses.size());
  for (std::size_t n = 0; n < image.size(); ++n)
    image[n] = water * masses.of(xray::Basis::kWater)[n] + bone * masses.of(xray::Basis::kBone)[n];
  return image;
}

double correlation(const std::vector<float>& a, const std::vector<float>& b) {
  double mean_a = 0.0, mean_b = 0.0;
  const auto count = static_cast<double>(a.size());
  for (std::size_t n = 0; n < a.size(); ++n) {
    mean_a += static_cast<double>(a[n]) / count;
    mean_b += static_cast<double>(b[n]) / count;
  }
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    const double x = static_cast<double>(a[n]) - mean_a, y = static_cast<double>(b[n]) - mean_b;
    ab += x * y;
    aa += x * x;
    bb += y * y;
  }
  return ab / std::sqrt(aa * bb);
}

/// One view against plastimatch.
Status compare(const View& view, const xray::XrayVolume& volume, const fs::path& ct, const fs::path& folder,
               std::vector<CaseResult>& results) {
  const xray::XrayRays rays = xray::rays_of(view.arm);
  xray::MassImage masses;
  Figures best;
  double peer_ms = std::numeric_limits<double>::infinity(), likeness = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    const Figures figures = time_ms(1, kImagesPerRound, [&] { xray::project(volume, rays, masses); });
    if (!best.median || *figures.median < *best.median) best = figures;
    TROCAR_TRY(const PeerImage peer, run_plastimatch(ct, view.arm, folder));
    peer_ms = std::min(peer_ms, peer.ms);
    likeness = correlation(attenuation_of(masses), peer.pixels);
  }
  if (likeness < kLeastCorrelation)
    return fail(fmt::format("the image differs from plastimatch's: correlation {:.5f}", likeness),
                fmt::format("drr/512{}", view.name), "compare both images");
  results.push_back({fmt::format("drr/512{}", view.name), "ms", best,
                     CaseResult::Peer{"plastimatch", peer_ms, peer_ms / *best.median},
                     fmt::format("256^3, water and bone; the peer: one material, without reading, converting and "
                                 "writing; correlation {:.5f}",
                                 likeness)});
  return {};
}

}  // namespace

Result<std::vector<CaseResult>> run_xray_benchmark(const Options& options) {
  std::vector<CaseResult> results;
  const TemporaryFolder folder;
  core::report(options.progress, "generating the patient", 0.0);
  TROCAR_TRY(auto small, phantom::generate_phantom("abdomen", 1, {{kCtSide, kCtSide, kCtSide}, 0.0}));
  const fs::path ct = folder.path() / "ct.nrrd";
  TROCAR_TRY_STATUS(io::write_image(attenuation_of(small.ct), ct));
  TROCAR_TRY(const auto volume, xray::XrayVolume::from_ct(small.ct));
  const std::vector<View> all = views(middle_P(small.ct.geometry));
  for (const View& view : all) {
    core::report(options.progress, "projecting", 0.3);
    TROCAR_TRY_STATUS(compare(view, *volume, ct, folder.path(), results));
  }

  TROCAR_TRY(const xray::Spectrum spectrum, xray::tube_spectrum({}));
  TROCAR_TRY(const xray::Beam beam, xray::Beam::make(spectrum));
  xray::MassImage masses;
  const xray::XrayRays rays = xray::rays_of(all.front().arm);
  xray::project(*volume, rays, masses);
  std::vector<float> signal(masses.size());
  Figures figures = time_ms(2, 100, [&] { beam.signals(masses, signal); });
  results.push_back({"drr/512-poly", "ms", figures, {}, "signal of 80 kV behind the masses; drr/512 before it"});

  core::report(options.progress, "turning the C-arm", 0.8);
  TROCAR_TRY(auto full, phantom::generate_phantom("abdomen", 1, {{0, 0, 0}, 1.0}));
  const auto patient = std::make_shared<const anatomy::VirtualPatient>(std::move(full));
  const auto start = std::chrono::steady_clock::now();
  TROCAR_TRY(const auto body, xray::XrayVolume::make(patient));
  const double make_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  results.push_back({"drr/volume", "ms", figure_of(make_ms), {}, "the patient's basis materials, once"});
  xray::CArm arm = all.front().arm;
  arm.field_mm = 300.0;
  arm.isocentre_P = middle_P(patient->ct.geometry);
  int frame = 0;
  figures = time_ms(5, kTurningFrames, [&] {
    const double turn = static_cast<double>(frame++) / kTurningFrames;
    arm.lao_deg = 90.0 * std::sin(6.28 * turn);
    arm.cranial_deg = 30.0 * std::sin(6.28 * 3.0 * turn);
    xray::project(*body, xray::rays_of(arm), masses);
    beam.signals(masses, signal);
  });
  const auto& size = patient->ct.geometry.size;
  results.push_back({"drr/512-moving",
                     "ms",
                     figures,
                     {},
                     fmt::format("{}x{}x{} voxels of 1 mm, masses and signal, C-arm turning: {:.0f} frames/s; bar 15",
                                 size[0], size[1], size[2], 1e3 / *figures.median)});
  core::report(options.progress, "fluoroscopy", 0.9);
  TROCAR_TRY(const auto fluoroscopy, fluoroscopy_cases());
  results.insert(results.end(), fluoroscopy.begin(), fluoroscopy.end());
  TROCAR_TRY(const auto contrast, contrast_cases(options.progress));
  results.insert(results.end(), contrast.begin(), contrast.end());
  return results;
}

}  // namespace trocar::bench
