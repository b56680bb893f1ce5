#include "io/detail/itk_transform.h"

#include <itkAffineTransform.h>
#include <itkBSplineTransform.h>
#include <itkCompositeTransform.h>
#include <itkTransformFactory.h>
#include <itkTransformFactoryBase.h>
#include <itkTransformFileReader.h>
#include <itkTransformFileWriter.h>
#include <itkTxtTransformIO.h>

#include <algorithm>
#include <mutex>

#include "io/image/detail/itk_image.h"

namespace trocar::io::detail {
namespace fs = std::filesystem;
namespace {

using Linear = itk::MatrixOffsetTransformBase<double, 3, 3>;

/// ITK knows its usual transforms, but not the base class of all linear ones, which other programs write.
void register_transforms() {
  static std::once_flag once;
  std::call_once(once, [] {
    itk::TransformFactoryBase::RegisterDefaultTransforms();
    itk::TransformFactory<Linear>::RegisterTransform();
  });
}

/// May throw exceptions of ITK.
Result<AffineMap> read_transform_throwing(const InputFile& file) {
  const std::string where = file.path().string();
  register_transforms();
  const auto reader = itk::TransformFileReaderTemplate<double>::New();
  reader->SetFileName(file.pinned_path().string());
  reader->SetTransformIO(itk::TxtTransformIOTemplate<double>::New());
  reader->Update();
  const auto& transforms = *reader->GetModifiableTransformList();
  if (transforms.size() != 1)
    return fail("holds several transforms, not one", where, "harden them into one linear transform");
  const auto* linear = dynamic_cast<const Linear*>(transforms.front().GetPointer());
  if (linear == nullptr)
    return fail("not a linear transform", where, "give a rigid transform (rotation and translation)");
  AffineMap map;
  for (unsigned row = 0; row < 3; ++row) {
    for (unsigned column = 0; column < 3; ++column) map.matrix[row][column] = linear->GetMatrix()(row, column);
    map.offset_mm[row] = linear->GetOffset()[row];
  }
  // The loaded transform has as many parameters as the file contains; a new one of the same type has as many as it
  // needs.
  const itk::LightObject::Pointer another = linear->CreateAnother();
  const auto* fresh = dynamic_cast<const Linear*>(another.GetPointer());
  if (fresh == nullptr)
    return fail("not a linear transform", where, "give a rigid transform (rotation and translation)");
  map.parameters = fresh->GetNumberOfParameters();
  map.fixed_parameters = fresh->GetNumberOfFixedParameters();
  return map;
}

using Composite = itk::CompositeTransform<double, 3>;
using Spline = itk::BSplineTransform<double, 3, 3>;
using Affine = itk::AffineTransform<double, 3>;

Affine::Pointer affine_of(const AffineMap& map) {
  const auto affine = itk::AffineTransform<double, 3>::New();
  itk::Matrix<double, 3, 3> matrix;
  itk::Vector<double, 3> offset;
  for (unsigned row = 0; row < 3; ++row) {
    for (unsigned column = 0; column < 3; ++column) matrix(row, column) = map.matrix[row][column];
    offset[row] = map.offset_mm[row];
  }
  affine->SetMatrix(matrix);
  affine->SetOffset(offset);
  return affine;
}

Spline::Pointer spline_of(const SplineNumbers& numbers) {
  const auto spline = Spline::New();
  Spline::FixedParametersType fixed(18);
  for (unsigned a = 0; a < 3; ++a) {
    fixed[a] = numbers.size[a];
    fixed[3 + a] = numbers.origin_mm[a];
    fixed[6 + a] = numbers.spacing_mm[a];
    for (unsigned b = 0; b < 3; ++b) fixed[9 + 3 * a + b] = numbers.direction[a][b];
  }
  spline->SetFixedParameters(fixed);
  const std::size_t count = numbers.coefficients_mm.size();
  Spline::ParametersType parameters(static_cast<itk::SizeValueType>(3 * count));
  for (std::size_t n = 0; n < count; ++n)
    for (std::size_t a = 0; a < 3; ++a)
      parameters[static_cast<itk::SizeValueType>(a * count + n)] = numbers.coefficients_mm[n][a];
  spline->SetParametersByValue(parameters);
  return spline;
}

/// May throw exceptions of ITK.
void write_transform_throwing(const itk::Object* transform, const fs::path& path) {
  const auto writer = itk::TransformFileWriterTemplate<double>::New();
  writer->SetFileName(path.string());
  writer->SetTransformIO(itk::TxtTransformIOTemplate<double>::New());
  writer->SetInput(transform);
  writer->Update();
}

Status unwritten(const fs::path& path) {
  return fail("the transform cannot be written", path.string(), "check the disk space and the permissions");
}

}  // namespace

Result<AffineMap> read_transform_with_itk(const InputFile& file) {
  const ItkCall call;
  try {
    return read_transform_throwing(file);
  } catch (const std::exception&) {
    return fail("not an ITK transform file", file.path().string(),
                "save a linear transform as .tfm, for example in 3D Slicer");
  }
}

Status write_transform_with_itk(const AffineMap& map, const fs::path& path) {
  const ItkCall call;
  try {
    write_transform_throwing(affine_of(map), path);
    return {};
  } catch (const std::exception&) {
    return unwritten(path);
  }
}

Status write_composite_with_itk(const AffineMap& map, const SplineNumbers& spline, const fs::path& path) {
  const ItkCall call;
  try {
    const auto composite = Composite::New();
    composite->AddTransform(affine_of(map));
    composite->AddTransform(spline_of(spline));  // the last one is applied first
    write_transform_throwing(composite, path);
    return {};
  } catch (const std::exception&) {
    return unwritten(path);
  }
}

Result<std::vector<std::array<double, 3>>> map_points_with_itk(const fs::path& path,
                                                               std::span<const std::array<double, 3>> points) {
  const ItkCall call;
  try {
    register_transforms();
    const auto reader = itk::TransformFileReaderTemplate<double>::New();
    reader->SetFileName(path.string());
    reader->SetTransformIO(itk::TxtTransformIOTemplate<double>::New());
    reader->Update();
    const auto* transform =
        dynamic_cast<const itk::Transform<double, 3, 3>*>(reader->GetTransformList()->front().GetPointer());
    if (transform == nullptr) return fail("not a transform of points in 3D", path.string(), "give an ITK transform");
    std::vector<std::array<double, 3>> mapped;
    for (const auto& point : points) {
      itk::Point<double, 3> p;
      std::copy(point.begin(), point.end(), p.Begin());
      p = transform->TransformPoint(p);
      mapped.push_back({p[0], p[1], p[2]});
    }
    return mapped;
  } catch (const std::exception&) {
    return fail("not an ITK transform file", path.string(), "give an ITK transform in text (.tfm)");
  }
}

}  // namespace trocar::io::detail
