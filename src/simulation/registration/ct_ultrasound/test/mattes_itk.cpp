#include "mattes_itk.h"

#include <itkEuler3DTransform.h>
#include <itkImage.h>
#include <itkMattesMutualInformationImageToImageMetricv4.h>
#include <itkMultiThreaderBase.h>

#include <algorithm>
#include <exception>
#include <mutex>

namespace trocar::registration::testing {
namespace {

using Image = itk::Image<float, 3>;
using Metric = itk::MattesMutualInformationImageToImageMetricv4<Image, Image>;
using SampledPoints = Metric::FixedSampledPointSetType;
using Euler = itk::Euler3DTransform<double>;

/// An ITK image that shares the voxels.
Image::Pointer image_of(const ImageView& view) {
  const auto image = Image::New();
  Image::SizeType size;
  Image::SpacingType spacing;
  Image::PointType origin;
  Image::DirectionType direction;
  std::size_t count = 1;
  for (unsigned a = 0; a < 3; ++a) {
    size[a] = static_cast<itk::SizeValueType>(view.size[a]);
    count *= static_cast<std::size_t>(view.size[a]);
    spacing[a] = view.spacing_mm[a];
    origin[a] = view.origin_mm[a];
    for (unsigned b = 0; b < 3; ++b) direction(a, b) = view.direction[a][b];
  }
  image->SetRegions(Image::RegionType(size));
  image->SetSpacing(spacing);
  image->SetOrigin(origin);
  image->SetDirection(direction);
  // The metric only reads the voxels.
  image->GetPixelContainer()->SetImportPointer(const_cast<float*>(view.voxels), count, false);
  return image;
}

SampledPoints::Pointer points_of(std::span<const std::array<double, 3>> points) {
  auto result = SampledPoints::New();
  result->GetPoints()->Reserve(points.size());
  for (std::size_t n = 0; n < points.size(); ++n) {
    SampledPoints::PointType point;
    std::copy(points[n].begin(), points[n].end(), point.Begin());
    result->SetPoint(n, point);
  }
  return result;
}

/// A metric of one thread: several add their derivatives in any order. ITK's only setting with an effect is the default
/// at the time of construction.
Metric::Pointer make_metric() {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  const auto threads = itk::MultiThreaderBase::GetGlobalDefaultNumberOfThreads();
  itk::MultiThreaderBase::SetGlobalDefaultNumberOfThreads(1);
  const Metric::Pointer metric = Metric::New();
  itk::MultiThreaderBase::SetGlobalDefaultNumberOfThreads(threads);
  return metric;
}

}  // namespace

struct MattesItk::State {
  Euler::Pointer transform = Euler::New();
  Metric::Pointer metric = make_metric();

  void move(const MotionNumbers& motion) {
    Euler::ParametersType parameters(6);
    std::copy(motion.begin(), motion.end(), parameters.begin());
    transform->SetParameters(parameters);
  }
};

MattesItk::MattesItk(const ImageView& us, const ImageView& ct, std::span<const std::array<double, 3>> points,
                     const std::array<double, 3>& centre, int bins)
    : state_(std::make_unique<State>()) {
  const Image::Pointer fixed = image_of(us);
  Euler::InputPointType rotation_centre;
  std::copy(centre.begin(), centre.end(), rotation_centre.Begin());
  state_->transform->SetIdentity();
  state_->transform->SetCenter(rotation_centre);
  Metric& metric = *state_->metric;
  metric.SetFixedImage(fixed);
  metric.SetMovingImage(image_of(ct));
  metric.SetVirtualDomainFromImage(fixed);
  metric.SetUseFixedImageGradientFilter(false);
  metric.SetUseMovingImageGradientFilter(false);
  metric.SetNumberOfHistogramBins(static_cast<itk::SizeValueType>(bins));
  metric.SetMovingTransform(state_->transform);
  metric.SetFixedSampledPointSet(points_of(points));
  metric.SetUseSampledPointSet(true);
  metric.Initialize();
}

MattesItk::~MattesItk() = default;

double MattesItk::value(const MotionNumbers& motion) {
  state_->move(motion);
  try {
    return -state_->metric->GetValue();
  } catch (const std::exception&) {
    return 0.0;
  }
}

MattesItk::Slope MattesItk::value_and_gradient(const MotionNumbers& motion) {
  state_->move(motion);
  try {
    Metric::MeasureType value{};
    Metric::DerivativeType derivative(6);
    state_->metric->GetValueAndDerivative(value, derivative);
    Slope slope;
    slope.value = -value;
    std::copy(derivative.begin(), derivative.end(), slope.gradient.begin());  // ITK: the descent of -MI
    return slope;
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace trocar::registration::testing
