#include "io/transform_file.h"

#include <Eigen/SVD>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string>
#include <string_view>

#include "core/atomic_file.h"
#include "io/detail/itk_transform.h"

namespace trocar {
namespace fs = std::filesystem;
namespace {

constexpr double kMaxDeviation = 1e-4;      ///< Of R^T R from identity.
constexpr std::size_t kMaxBytes = 1 << 20;  ///< A linear transform takes some hundred bytes.

/// True for "1 -2.5 3e4": finite numbers, at least one.
bool are_numbers(std::string_view text) {
  bool any = false;
  while (true) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return any;
    text.remove_prefix(first);
    const std::string_view word = text.substr(0, text.find_first_of(" \t\r"));
    double number = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(number)) return false;
    text.remove_prefix(word.size());
    any = true;
  }
}

/// ITK's reader trusts its input and takes what it cannot read for the identity.
Status check_text(const std::string& text, const std::string& where) {
  const auto bad = [&](const char* what) {
    return fail(what, where, "save a linear transform as .tfm, for example in 3D Slicer");
  };
  if (!text.starts_with("#Insight Transform File")) return bad("is no ITK transform file");
  std::istringstream lines(text);
  bool has_parameters = false;
  for (std::string line; std::getline(lines, line);) {
    const auto colon = line.find(':');
    if (colon == std::string::npos || (!line.starts_with("Parameters:") && !line.starts_with("FixedParameters:")))
      continue;
    if (!are_numbers(std::string_view(line).substr(colon + 1)))
      return bad("the transform has a parameter that is no number");
    has_parameters = has_parameters || line.starts_with("Parameters:");
  }
  if (!has_parameters) return bad("the transform has no parameters");
  return {};
}

}  // namespace

Result<Pose> read_transform(const fs::path& path) {
  TROCAR_TRY(const std::string text, read_file(path, kMaxBytes));
  TROCAR_TRY_STATUS(check_text(text, path.string()));
  TROCAR_TRY(const detail::AffineMap map, detail::read_transform_with_itk(path));
  Mat3 matrix;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      matrix(row, column) = map.matrix[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
  const Vec3 offset(map.offset_mm[0], map.offset_mm[1], map.offset_mm[2]);
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
