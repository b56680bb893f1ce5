#include "io/image/detail/raw_volume.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/SVD>
#include <algorithm>
#include <atomic>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <set>

#include "core/parallel.h"

namespace trocar::io::detail {
namespace {

constexpr std::size_t kVoxelsAtOnce = std::size_t{1} << 18;

/// Calls use(S{}) with the C++ type S of the stored numbers.
template <class Use>
auto with_type(VoxelType type, Use&& use) {
  switch (type) {
    case VoxelType::kUInt8:
      return use(std::uint8_t{});
    case VoxelType::kInt8:
      return use(std::int8_t{});
    case VoxelType::kUInt16:
      return use(std::uint16_t{});
    case VoxelType::kInt16:
      return use(std::int16_t{});
    case VoxelType::kUInt32:
      return use(std::uint32_t{});
    case VoxelType::kInt32:
      return use(std::int32_t{});
    case VoxelType::kUInt64:
      return use(std::uint64_t{});
    case VoxelType::kInt64:
      return use(std::int64_t{});
    case VoxelType::kFloat:
      return use(float{});
    case VoxelType::kDouble:
      break;
  }
  return use(double{});
}

/// The numbers above 255 if all numbers are integers, at most 8 of them, sorted; otherwise empty.
std::vector<int> labels_above_255(const RawVoxels& in, std::size_t voxels) {
  return with_type(in.type, [&]<class S>(S) {
    constexpr std::size_t kMost = 8;
    std::set<int> above;
    for (std::size_t n = 0; n < voxels; ++n) {
      S stored;
      std::memcpy(&stored, in.bytes.data() + n * sizeof(S), sizeof(S));
      const double value = static_cast<double>(stored) * in.slope + in.intercept;
      const bool is_label = value >= 0.0 && value < 1e6 && value == std::round(value);
      if (!is_label) return std::vector<int>();
      if (value > 255.0 && above.size() < kMost) above.insert(static_cast<int>(value));
    }
    return std::vector<int>(above.begin(), above.end());
  });
}

/// Converts all numbers in parallel with convert(value, out&) -> bool; returns a value that could not be converted.
template <class T, class Convert>
std::optional<double> convert_all(const RawVoxels& in, std::span<T> out, const Convert& convert) {
  return with_type(in.type, [&]<class S>(S) -> std::optional<double> {
    TROCAR_CHECK(in.bytes.size() == out.size() * sizeof(S));
    std::atomic<bool> any_bad{false};
    double bad_value = 0.0;
    parallel_for(out.size(), kVoxelsAtOnce, [&](std::size_t first, std::size_t last) {
      const std::byte* source = in.bytes.data() + first * sizeof(S);
      for (std::size_t n = first; n < last; ++n, source += sizeof(S)) {
        S stored;
        std::memcpy(&stored, source, sizeof(S));
        const double value = static_cast<double>(stored) * in.slope + in.intercept;
        if (convert(value, out[n])) continue;
        if (!any_bad.exchange(true)) bad_value = value;
        return;
      }
    });
    return any_bad ? std::optional(bad_value) : std::nullopt;
  });
}

bool is_plain(const RawVoxels& in, VoxelType type) {
  return in.type == type && in.slope == 1.0 && in.intercept == 0.0;
}

template <class T>
void copy_plain(const RawVoxels& in, std::span<T> out) {
  TROCAR_CHECK(in.bytes.size() == out.size_bytes());
  std::memcpy(out.data(), in.bytes.data(), in.bytes.size());
}

/// Whole numbers 0..255; returns the first value that is none.
std::optional<double> convert_whole(const RawVoxels& in, std::span<std::uint8_t> out) {
  if (is_plain(in, VoxelType::kUInt8)) {
    copy_plain(in, out);
    return std::nullopt;
  }
  return convert_all(in, out, [](double value, std::uint8_t& voxel) {
    if (!(value > -0.5 && value < 255.5)) return false;
    const double whole = std::round(value);
    voxel = static_cast<std::uint8_t>(whole);
    // Numbers stored with a float scaling are whole only up to its rounding.
    return std::abs(value - whole) <= 1e-3;
  });
}

/// NaN or infinity.
Status not_finite(const char* what, double value) {
  if (std::isnan(value))
    return fail(fmt::format("the {} has a voxel that is not a number", what), {}, "export it again without NaN");
  return fail(fmt::format("the {} has an infinite voxel ({}infinity)", what, value < 0.0 ? "-" : "+"), {},
              "export it again with a number there (a CT: -1024 where nothing was measured)");
}

}  // namespace

std::size_t bytes_per_voxel(VoxelType type) noexcept {
  return with_type(type, []<class S>(S) { return sizeof(S); });
}

void round_geometry(volume::GridGeometry& geometry) {
  constexpr double kRounding = 1e-12;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string text = fmt::format("{:.15g}", geometry.spacing_mm[axis]);
    std::from_chars(text.data(), text.data() + text.size(), geometry.spacing_mm[axis]);
    int along = 0;
    const double most = geometry.R_PV.col(axis).cwiseAbs().maxCoeff(&along);
    const double sign = geometry.R_PV(along, axis) < 0.0 ? -1.0 : 1.0;
    const Vec3 unit = sign * Vec3::Unit(along);
    if (most > 0.5 && (geometry.R_PV.col(axis) - unit).cwiseAbs().maxCoeff() < kRounding)
      geometry.R_PV.col(axis) = unit;
  }
}

Status tidy_geometry(volume::GridGeometry& geometry) {
  if (!geometry.spacing_mm.allFinite() || !geometry.origin_P.allFinite() || !geometry.R_PV.allFinite())
    return fail("the position of the image is not a number", {}, "export it again");
  if ((geometry.spacing_mm.array() <= 0.0).any())
    return fail("the voxel spacing is not above zero", {}, "export the image with its spacing");
  const Mat3 product = geometry.R_PV.transpose() * geometry.R_PV;
  if ((product - Mat3::Identity()).cwiseAbs().maxCoeff() > kMaxShear)
    return fail("the image's axes are sheared or scaled, not at right angles", {}, "resample it onto a straight grid");
  // The nearest orthonormal matrix, so that rounding errors of the file do not grow with the size of the volume.
  const Eigen::JacobiSVD<Mat3> svd(geometry.R_PV, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Mat3 nearest = svd.matrixU() * svd.matrixV().transpose();
  if ((nearest - geometry.R_PV).cwiseAbs().maxCoeff() > 1e-12) geometry.R_PV = nearest;
  geometry.R_PV.array() += 0.0;  // -0 becomes 0.
  geometry.origin_P.array() += 0.0;
  round_geometry(geometry);
  return {};
}

template <class T>
void make_right_handed(volume::Grid<T>& grid) {
  volume::GridGeometry& g = grid.geometry;
  if (g.R_PV.determinant() > 0.0) return;
  g.origin_P = g.to_mm({0.0, 0.0, static_cast<double>(g.size[2] - 1)});
  g.R_PV.col(2) = -g.R_PV.col(2);
  g.R_PV.array() += 0.0;  // -0 becomes 0.
  const auto slice = static_cast<std::size_t>(g.size[0] * g.size[1]);
  for (std::size_t low = 0, high = static_cast<std::size_t>(g.size[2]) - 1; low < high; ++low, --high)
    std::swap_ranges(grid.voxels.data() + low * slice, grid.voxels.data() + (low + 1) * slice,
                     grid.voxels.data() + high * slice);
}

template <class T>
Result<volume::Grid<T>> to_grid(const RawVolume& raw, const std::string& where, Converter<T> convert) {
  if (raw.components != 1)
    return fail("has several values in each voxel (colour or vectors)", where, "give an image of one value a voxel");
  volume::Grid<T> grid;
  grid.geometry = raw.geometry;
  Status status = tidy_geometry(grid.geometry);
  if (status) {
    grid.voxels.resize(grid.geometry.voxel_count());
    status = convert(raw.voxels(), grid.voxels);
  }
  if (!status) return fail(status.error().what, where, status.error().advice);
  make_right_handed(grid);
  return grid;
}

template Result<volume::Grid<std::int16_t>> to_grid(const RawVolume&, const std::string&, Converter<std::int16_t>);
template Result<volume::Grid<std::uint8_t>> to_grid(const RawVolume&, const std::string&, Converter<std::uint8_t>);
template Result<volume::Grid<float>> to_grid(const RawVolume&, const std::string&, Converter<float>);

Status convert_voxels(const RawVoxels& in, std::span<std::int16_t> out) {
  if (is_plain(in, VoxelType::kInt16)) {
    copy_plain(in, out);
    return {};
  }
  const auto bad = convert_all(in, out, [](double value, std::int16_t& voxel) {
    // Written so that NaN and +infinity fail.
    if (!(value < 32767.5) || value == -HUGE_VAL) return false;
    voxel = static_cast<std::int16_t>(std::lround(std::max(value, -32768.0)));
    return true;
  });
  if (!bad) return {};
  if (!std::isfinite(*bad)) return not_finite("image", *bad);
  return fail(fmt::format("the image contains the value {:g}, which is not a valid HU", *bad), {},
              "give a CT in Hounsfield units");
}

Status convert_voxels(const RawVoxels& in, std::span<std::uint8_t> out) {
  const auto bad = convert_whole(in, out);
  if (!bad) return {};
  if (!std::isfinite(*bad)) return not_finite("image", *bad);
  if (const std::vector<int> above = labels_above_255(in, out.size()); !above.empty())
    return fail(fmt::format("the segmentation has label numbers above 255: {}", fmt::join(above, ", ")), {},
                "give its structures numbers from 1 to 255");
  return fail(fmt::format("the image contains the value {:g}, which is not a label (whole numbers 0 to 255)", *bad), {},
              "give a segmentation, not an image of intensities");
}

Status convert_gray(const RawVoxels& in, std::span<std::uint8_t> out) {
  const auto bad = convert_all(in, out, [](double value, std::uint8_t& voxel) {
    if (!(value > -0.5 && value < 255.5)) return false;
    voxel = static_cast<std::uint8_t>(std::round(value));
    return true;
  });
  if (bad && !std::isfinite(*bad)) return not_finite("image", *bad);
  if (bad)
    return fail(fmt::format("the image contains the value {:g}, which is not a gray level (0 to 255)", *bad), {},
                "export the ultrasound with one byte per voxel");
  if (has_fractions(in) && std::all_of(out.begin(), out.end(), [](std::uint8_t voxel) { return voxel <= 1; }))
    return fail("the image contains fractions from 0 to 1, not gray levels from 0 to 255", {},
                "multiply it by 255, or export the ultrasound with one byte per voxel");
  return {};
}

bool has_fractions(const RawVoxels& in) {
  return with_type(in.type, [&]<class S>(S) {
    for (std::size_t at = 0; at + sizeof(S) <= in.bytes.size(); at += sizeof(S)) {
      S stored;
      std::memcpy(&stored, in.bytes.data() + at, sizeof(S));
      const double value = static_cast<double>(stored) * in.slope + in.intercept;
      if (std::abs(value - std::round(value)) > 1e-3) return true;
    }
    return false;
  });
}

Status convert_voxels(const RawVoxels& in, std::span<float> out) {
  const auto bad = convert_all(in, out, [](double value, float& voxel) {
    voxel = static_cast<float>(value);
    return std::isfinite(voxel);
  });
  return bad ? not_finite("image", *bad) : Status{};
}

Status convert_mask(const RawVoxels& in, std::span<std::uint8_t> out) {
  const auto bad = convert_all(in, out, [](double value, std::uint8_t& voxel) {
    voxel = value > 0.0 ? 1 : 0;
    return !std::isnan(value);
  });
  if (!bad) return {};
  return fail("the mask has a voxel that is not a number", {}, "export it again without NaN");
}

}  // namespace trocar::io::detail
