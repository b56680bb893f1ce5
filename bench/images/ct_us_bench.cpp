// Ultrasound registered to a CT: error against the known pose and time of the whole program, elastix and plastimatch on
// the same files.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>

#include "bench/benchmarks.h"
#include "bench/images/ct_us_peers.h"
#include "bench/real_data.h"
#include "core/files/folders.h"
#include "core/random.h"
#include "io/image/image_file.h"
#include "io/sequence/transform_file.h"
#include "lab/registration/generated_pair.h"
#include "phantom/phantom.h"
#include "registration/ct_ultrasound/rigid_registration.h"

namespace trocar::bench {
namespace {
namespace fs = std::filesystem;

constexpr int kPairs = 10;
constexpr double kOffset_mm = 10.0, kOffset_rad = radians(10.0);

/// Errors and times of one program over all seeds.
struct Runs {
  std::vector<double> error_mm, seconds;
  int failures = 0;
};

Result<Pose> register_by_trocar(const PairFiles& files, const fs::path& out) {
  TROCAR_TRY_STATUS(
      run_trocar({"register", "--ct", files.ct.string(), "--us", files.us.string(), "--out", out.string()}));
  return io::read_transform(out);
}

/// Runs one program; a failure counts without an error.
template <class Program>
void measure(Runs& runs, const volume::LabelGrid& us, const registration::Beams& beams, const Pose& X_CU,
             Program program) {
  const auto start = std::chrono::steady_clock::now();
  const Result<Pose> found = program();
  if (!found) {
    ++runs.failures;
    return;
  }
  runs.seconds.push_back(seconds_since(start));
  const auto error_mm = registration::mean_distance_mm(us, beams, *found, X_CU);
  if (error_mm) runs.error_mm.push_back(*error_mm);
}

std::optional<CaseResult::Peer> peer_of(const char* name, const std::vector<double>& ours,
                                        const std::vector<double>& theirs) {
  const auto our = figures_of(ours).median, their = figures_of(theirs).median;
  if (!our || !their) return std::nullopt;
  return CaseResult::Peer{name, *their, *their / *our};
}

Figures with_largest(std::vector<double> values) {
  Figures figures = figures_of(values);
  if (!values.empty()) figures.max = *std::max_element(values.begin(), values.end());
  return figures;
}

std::string failures_of(const Runs& runs) {
  return runs.failures == 0 ? std::string() : fmt::format(", {} of {} failed", runs.failures, kPairs);
}

void add_cases(const Runs& ours, const Runs& elastix, const Runs& plastimatch, std::vector<CaseResult>& results) {
  const std::string what = fmt::format("{} seeds, 128x128x128 voxels of 1.5 mm, 10 mm and 10 degrees off", kPairs);
  results.push_back({"ct-us/error", "mm", with_largest(ours.error_mm),
                     peer_of("elastix", ours.error_mm, elastix.error_mm), what + failures_of(ours)});
  results.push_back({"ct-us/seconds", "s", with_largest(ours.seconds),
                     peer_of("elastix", ours.seconds, elastix.seconds), "the whole process"});
  results.push_back({"ct-us/error-plastimatch", "mm", with_largest(ours.error_mm),
                     peer_of("plastimatch", ours.error_mm, plastimatch.error_mm), "the same runs of Trocar"});
  results.push_back({"ct-us/seconds-plastimatch", "s", with_largest(ours.seconds),
                     peer_of("plastimatch", ours.seconds, plastimatch.seconds), "the same runs of Trocar"});
  const auto add_worst = [&](const char* name, const Runs& runs) {
    if (runs.error_mm.empty()) return;
    results.push_back({name, "mm", with_largest(runs.error_mm), {}, "errors of the peer" + failures_of(runs)});
  };
  add_worst("ct-us/elastix-error", elastix);
  add_worst("ct-us/plastimatch-error", plastimatch);
}

}  // namespace

Result<std::vector<CaseResult>> run_ct_us_benchmark(const Options& options) {
  const TemporaryFolder folder;
  Runs ours, elastix, plastimatch;
  for (int seed = 1; seed <= kPairs; ++seed) {
    core::report(options.progress, "registering", static_cast<double>(seed - 1) / kPairs);
    registration::testing::PairOptions pair_options;
    pair_options.size = 128;
    pair_options.spacing_mm = 1.5;
    pair_options.offset_mm = kOffset_mm;
    pair_options.offset_rad = kOffset_rad;
    pair_options.seed = static_cast<std::uint64_t>(seed);
    const registration::testing::GeneratedPair pair = registration::testing::make_pair(pair_options);
    TROCAR_TRY(const registration::Beams beams, registration::Beams::along_axis("+y", pair.us.geometry));
    const fs::path own = folder.path() / fmt::format("{}", seed);
    fs::create_directories(own);
    const PairFiles files{own / "ct.nrrd", own / "us.nrrd", own / "mask.nrrd"};
    TROCAR_TRY(const volume::MaskGrid mask, registration::usable_voxels(pair.us, beams));
    TROCAR_TRY_STATUS(io::write_image(pair.ct, files.ct));
    TROCAR_TRY_STATUS(io::write_image(pair.us, files.us));
    TROCAR_TRY_STATUS(io::write_image(mask, files.us_mask));
    measure(ours, pair.us, beams, pair.X_CU, [&] { return register_by_trocar(files, own / "trocar.tfm"); });
    measure(elastix, pair.us, beams, pair.X_CU, [&] { return run_elastix(files, own / "elastix"); });
    measure(plastimatch, pair.us, beams, pair.X_CU, [&] { return run_plastimatch(files, own / "plastimatch"); });
  }
  if (ours.error_mm.empty())
    return fail("trocar register failed on every pair", "ct-us", "run trocar register by hand to see why");
  std::vector<CaseResult> results;
  add_cases(ours, elastix, plastimatch, results);
  return results;
}

}  // namespace trocar::bench
