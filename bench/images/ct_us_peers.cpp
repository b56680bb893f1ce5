// Registration programs beside `trocar register`.
#include "bench/images/ct_us_peers.h"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <sstream>

#include "bench/real_data.h"
#include "io/sequence/transform_file.h"

namespace trocar::bench {
namespace fs = std::filesystem;
namespace {

constexpr const char* kElastix = R"((FixedInternalImagePixelType "float")
(MovingInternalImagePixelType "float")
(FixedImageDimension 3)
(MovingImageDimension 3)
(UseDirectionCosines "true")
(Registration "MultiResolutionRegistration")
(Interpolator "LinearInterpolator")
(ResampleInterpolator "FinalBSplineInterpolator")
(Resampler "DefaultResampler")
(FixedImagePyramid "FixedSmoothingImagePyramid")
(MovingImagePyramid "MovingSmoothingImagePyramid")
(Optimizer "AdaptiveStochasticGradientDescent")
(Transform "EulerTransform")
(Metric "AdvancedMattesMutualInformation")
(AutomaticTransformInitialization "false")
(AutomaticScalesEstimation "true")
(AutomaticParameterEstimation "true")
(HowToCombineTransforms "Compose")
(NumberOfHistogramBins 32)
(NumberOfResolutions 3)
(ImagePyramidSchedule 4 4 4 2 2 2 1 1 1)
(MaximumNumberOfIterations 250)
(NumberOfSpatialSamples 4000)
(NewSamplesEveryIteration "true")
(ImageSampler "RandomCoordinate")
(MaximumNumberOfSamplingAttempts 8)
(ErodeMask "false")
(RandomSeed 1)
(WriteResultImage "false")
)";

Status write_text(const fs::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) return fail("cannot write", path.string(), "free some disk space");
  return {};
}

/// Numbers of a line "(Name 1 2 3)".
std::vector<double> numbers_of(const fs::path& path, const std::string& name) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("(" + name + " ")) continue;
    std::istringstream words(line.substr(name.size() + 2));
    std::vector<double> numbers;
    for (double number = 0.0; words >> number;) numbers.push_back(number);
    return numbers;
  }
  return {};
}

}  // namespace

Result<Pose> run_elastix(const PairFiles& files, const fs::path& folder) {
  fs::create_directories(folder);
  TROCAR_TRY_STATUS(write_text(folder / "parameters.txt", kElastix));
  TROCAR_TRY_STATUS(
      run_quietly({"elastix", "-f", files.us.string(), "-m", files.ct.string(), "-fMask", files.us_mask.string(), "-p",
                   (folder / "parameters.txt").string(), "-out", folder.string()}));
  const fs::path out = folder / "TransformParameters.0.txt";
  const std::vector<double> p = numbers_of(out, "TransformParameters");
  const std::vector<double> c = numbers_of(out, "CenterOfRotationPoint");
  if (p.size() != 6 || c.size() != 3)
    return fail("elastix wrote no Euler transform", out.string(), "run it by hand to see why");
  const Mat3 R = (Eigen::AngleAxisd(p[2], Vec3::UnitZ()) * Eigen::AngleAxisd(p[0], Vec3::UnitX()) *
                  Eigen::AngleAxisd(p[1], Vec3::UnitY()))
                     .toRotationMatrix();
  const Vec3 centre(c[0], c[1], c[2]);
  return Pose(R, centre + Vec3(p[3], p[4], p[5]) - R * centre);
}

Result<Pose> run_plastimatch(const PairFiles& files, const fs::path& folder) {
  fs::create_directories(folder);
  const fs::path out = folder / "out.tfm";
  TROCAR_TRY_STATUS(
      write_text(folder / "command.txt",
                 fmt::format("[GLOBAL]\nfixed={}\nmoving={}\nfixed_roi={}\nxform_out={}\n"
                             "[STAGE]\nxform=rigid\noptim=versor\nimpl=itk\nmetric=mattes\nmi_histogram_bins=32\n"
                             "res=4 4 4\nmax_its=60\nmax_step=4\nmin_step=0.2\nnum_samples=20000\n"
                             "[STAGE]\nres=1 1 1\nmax_its=60\nmax_step=1\nmin_step=0.02\nnum_samples=100000\n",
                             files.us.string(), files.ct.string(), files.us_mask.string(), out.string())));
  TROCAR_TRY_STATUS(run_quietly({"plastimatch", "register", (folder / "command.txt").string()}));
  return io::read_transform(out);
}

}  // namespace trocar::bench
