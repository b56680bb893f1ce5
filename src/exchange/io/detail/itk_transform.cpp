#include "io/detail/itk_transform.h"

#include <itkAffineTransform.h>
#include <itkTransformFactory.h>
#include <itkTransformFactoryBase.h>
#include <itkTransformFileReader.h>
#include <itkTransformFileWriter.h>
#include <itkTxtTransformIO.h>

#include <mutex>

#include "io/image/detail/quiet.h"

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
Result<AffineMap> read_throwing(const InputFile& file) {
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

/// May throw exceptions of ITK.
void write_throwing(const AffineMap& map, const fs::path& path) {
  const auto affine = itk::AffineTransform<double, 3>::New();
  itk::Matrix<double, 3, 3> matrix;
  itk::Vector<double, 3> offset;
  for (unsigned row = 0; row < 3; ++row) {
    for (unsigned column = 0; column < 3; ++column) matrix(row, column) = map.matrix[row][column];
    offset[row] = map.offset_mm[row];
  }
  affine->SetMatrix(matrix);
  affine->SetOffset(offset);
  const auto writer = itk::TransformFileWriterTemplate<double>::New();
  writer->SetFileName(path.string());
  writer->SetTransformIO(itk::TxtTransformIOTemplate<double>::New());
  writer->SetInput(affine);
  writer->Update();
}

}  // namespace

Result<AffineMap> read_transform_with_itk(const InputFile& file) {
  silence_itk();
  try {
    return read_throwing(file);
  } catch (const std::exception&) {
    return fail("not an ITK transform file", file.path().string(),
                "save a linear transform as .tfm, for example in 3D Slicer");
  }
}

Status write_transform_with_itk(const AffineMap& map, const fs::path& path) {
  silence_itk();
  try {
    write_throwing(map, path);
    return {};
  } catch (const std::exception&) {
    return fail("the transform cannot be written", path.string(), "check the disk space and the permissions");
  }
}

}  // namespace trocar::io::detail
