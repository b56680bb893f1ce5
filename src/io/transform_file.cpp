#include "io/transform_file.h"

#include <fmt/format.h>

#include <Eigen/SVD>

#include "core/atomic_file.h"
#include "io/detail/itk_transform.h"

namespace trocar {
namespace fs = std::filesystem;
namespace {

constexpr double kMaxDeviation = 1e-4;      ///< Of R^T R from identity.
constexpr std::size_t kMaxBytes = 1 << 20;  ///< A linear transform takes some hundred bytes.

}  // namespace

Result<Pose> read_transform(const fs::path& path) {
  // ITK's reader trusts its input: what is no text transform never reaches it.
  TROCAR_TRY(const std::string text, read_file(path, kMaxBytes));
  if (!text.starts_with("#Insight Transform File"))
    return fail("is no ITK transform file", path.string(), "save a linear transform as .tfm, for example in 3D Slicer");
  TROCAR_TRY(const detail::AffineMap map, detail::read_transform_with_itk(path));
  Mat3 matrix;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      matrix(row, column) = map.matrix[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
  const Vec3 offset(map.offset_mm[0], map.offset_mm[1], map.offset_mm[2]);
  if (!matrix.allFinite() || !offset.allFinite())
    return fail("the transform has a value that is no number", path.string(), "export it again");
  const double deviation = (matrix.transpose() * matrix - Mat3::Identity()).cwiseAbs().maxCoeff();
  if (deviation > kMaxDeviation || matrix.determinant() < 0.0)
    return fail("the transform is not rigid: it scales, shears or mirrors", path.string(),
                "give a rotation and a translation only");
  const Eigen::JacobiSVD<Mat3> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return Pose(svd.matrixU() * svd.matrixV().transpose(), offset);
}

Status write_transform(const Pose& X_AB, const fs::path& path) {
  if (!X_AB.is_finite()) return fail("the pose has a value that is no number", path.string());
  detail::AffineMap map;
  for (int row = 0; row < 3; ++row) {
    const auto r = static_cast<std::size_t>(row);
    for (int column = 0; column < 3; ++column) map.matrix[r][static_cast<std::size_t>(column)] = X_AB.R()(row, column);
    map.offset_mm[r] = X_AB.p()[row];
  }
  return write_atomically(path,
                          [&](const fs::path& temporary) { return detail::write_transform_with_itk(map, temporary); });
}

}  // namespace trocar
