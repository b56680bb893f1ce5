#include "io/sequence/transform_file.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

#include "core/files/input_file.h"
#include "core/files/output_file.h"
#include "core/text.h"
#include "io/detail/itk_transform.h"

namespace trocar::io {
namespace fs = std::filesystem;
namespace {

constexpr double kMaxDeviation = 1e-4;  ///< Of R^T R from the identity.
constexpr const char* kNote = "# trocar ";
constexpr const char* kNoteEquals = " = ";
constexpr const char* kSaveAgain = "save a linear transform as .tfm, for example in 3D Slicer";

/// Count of the numbers in "1 -2.5 3e4"; empty if a word is not a finite number.
std::optional<std::size_t> count_numbers(std::string_view text) {
  for (std::size_t count = 0;; ++count) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return count;
    text.remove_prefix(first);
    const std::string_view word = text.substr(0, text.find_first_of(" \t\r"));
    if (!parse_number<double>(word)) return std::nullopt;
    text.remove_prefix(word.size());
  }
}

/// Count of numbers in a transform file; empty if the line is missing.
struct ParameterCounts {
  std::optional<std::size_t> parameters;
  std::optional<std::size_t> fixed_parameters;
};

/// ITK's reader does not report a missing line, a missing number or a truncated file: it returns the identity or zeros.
Result<ParameterCounts> count_parameters(const std::string& text, const std::string& where) {
  if (!text.starts_with("#Insight Transform File")) return fail("not an ITK transform file", where, kSaveAgain);
  // A file truncated within its last number has the full count of numbers.
  if (!text.ends_with('\n'))
    return fail("the last line has no line break: the file may be cut", where,
                "copy the file again, or end its last line with a line break");
  ParameterCounts counts;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool is_fixed = line.starts_with("FixedParameters:");
    if (!is_fixed && !line.starts_with("Parameters:")) continue;
    const auto count = count_numbers(std::string_view(line).substr(line.find(':') + 1));
    if (!count) return fail("the transform has a parameter that is not a number", where, kSaveAgain);
    (is_fixed ? counts.fixed_parameters : counts.parameters) = *count;
  }
  if (!counts.parameters || *counts.parameters == 0) return fail("the transform has no parameters", where, kSaveAgain);
  if (!counts.fixed_parameters)
    return fail("the transform has no fixed parameters: the file may be cut", where, kSaveAgain);
  return counts;
}

Status check_counts(const ParameterCounts& counts, const detail::AffineMap& map, const std::string& where) {
  const auto check = [&](const char* name, std::size_t found, std::size_t needed) -> Status {
    if (found == needed) return {};
    return fail(fmt::format("the transform has {} {}, its type needs {}: the file may be cut", found, name, needed),
                where, kSaveAgain);
  };
  TROCAR_TRY_STATUS(check("parameters", *counts.parameters, map.parameters));
  // Euler3DTransform of ITK 4 wrote the centre of rotation without the order of rotations.
  if (*counts.fixed_parameters == 3 && map.fixed_parameters == 4) return {};
  return check("fixed parameters", *counts.fixed_parameters, map.fixed_parameters);
}

detail::AffineMap map_of(const Pose& X_AB) {
  detail::AffineMap map;
  for (int row = 0; row < 3; ++row) {
    const auto r = static_cast<std::size_t>(row);
    for (int column = 0; column < 3; ++column) map.matrix[r][static_cast<std::size_t>(column)] = X_AB.R()(row, column);
    map.offset_mm[r] = X_AB.p()[row];
  }
  return map;
}

}  // namespace

Result<Pose> read_transform(const fs::path& path) {
  TROCAR_TRY(const InputFile file, InputFile::open(path, FileKind::kTransform));
  TROCAR_TRY(const std::string text, file.read_all());
  TROCAR_TRY(const ParameterCounts counts, count_parameters(text, path.string()));
  TROCAR_TRY(const detail::AffineMap map, detail::read_transform_with_itk(file));
  TROCAR_TRY_STATUS(check_counts(counts, map, path.string()));
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

Result<TransformNotes> read_transform_notes(const fs::path& path) {
  TROCAR_TRY(const std::string text, read_input(path, FileKind::kTransform));
  TransformNotes notes;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.ends_with('\r')) line.pop_back();
    const auto equals = line.find(kNoteEquals);
    if (!line.starts_with(kNote) || equals == std::string::npos) continue;
    const std::size_t name = std::string_view(kNote).size();
    notes[line.substr(name, equals - name)] = line.substr(equals + std::string_view(kNoteEquals).size());
  }
  return notes;
}

Status write_transform(const Pose& X_AB, const fs::path& path, const TransformNotes& notes) {
  if (!X_AB.is_finite()) return fail("the pose has a value that is not a number", path.string(), "give finite numbers");
  const detail::AffineMap map = map_of(X_AB);
  return write_atomically(path, [&](const fs::path& temporary) -> Status {
    TROCAR_TRY_STATUS(detail::write_transform_with_itk(map, temporary));
    std::ofstream file(temporary, std::ios::app | std::ios::binary);
    for (const auto& [name, value] : notes) file << kNote << name << kNoteEquals << value << '\n';
    file.flush();
    if (!file) return fail("the comments cannot be written", path.string(), "free some disk space");
    return {};
  });
}

Status write_deformation(const Pose& X_AB, const volume::SplineField& field_B, const fs::path& path) {
  detail::SplineNumbers numbers;
  bool is_finite = X_AB.is_finite();
  for (std::size_t a = 0; a < 3; ++a) {
    const auto row = static_cast<int>(a);
    numbers.size[a] = static_cast<double>(field_B.lattice.size[a]);
    numbers.origin_mm[a] = field_B.lattice.origin_P[row];
    numbers.spacing_mm[a] = field_B.lattice.spacing_mm[row];
    for (std::size_t b = 0; b < 3; ++b) numbers.direction[a][b] = field_B.lattice.R_PV(row, static_cast<int>(b));
  }
  for (const Vec3& c : field_B.coefficients_mm) {
    is_finite = is_finite && c.allFinite();
    numbers.coefficients_mm.push_back({c.x(), c.y(), c.z()});
  }
  if (!is_finite) return fail("the deformation has a value that is not a number", path.string(), "give finite numbers");
  return write_atomically(path, [&](const fs::path& temporary) {
    return detail::write_composite_with_itk(map_of(X_AB), numbers, temporary);
  });
}

}  // namespace trocar::io
