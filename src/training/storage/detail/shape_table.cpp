#include "storage/detail/shape_table.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "storage/detail/guarded_database.h"

namespace trocar::storage::detail {
namespace {

constexpr double kMicrometres = 1000.0;
constexpr int kMost_um = static_cast<int>(telemetry::kMostBeside_mm * kMicrometres);
constexpr std::size_t kMostText = telemetry::NeedleShape::kMostSpans * 2 * sizeof("-1000000");
constexpr std::size_t kShapesAFetch = 1024;

bool is_storable(const telemetry::NeedleShape& shape) {
  if (!std::isfinite(shape.time_s) || shape.spans > telemetry::NeedleShape::kMostSpans) return false;
  for (std::size_t i = 0; i < shape.spans; ++i)
    for (const float mm : shape.beside_mm[i])
      if (!(std::abs(static_cast<double>(mm)) <= telemetry::kMostBeside_mm)) return false;
  return true;
}

std::string to_text(const telemetry::NeedleShape& shape) {
  std::string text;
  for (std::size_t i = 0; i < shape.spans; ++i) {
    const auto um = [&](std::size_t axis) { return std::lround(kMicrometres * shape.beside_mm[i][axis]); };
    text += fmt::format("{}{} {}", i == 0 ? "" : " ", um(0), um(1));
  }
  return text;
}

/// Throws soci::soci_error.
telemetry::NeedleShape to_shape(double time_s, const std::string& text) {
  telemetry::NeedleShape shape;
  shape.time_s = time_s;
  const char* at = text.data();
  const char* const end = at + text.size();
  std::size_t numbers = 0;
  while (at != end) {
    int um = 0;
    const auto [next, error] = std::from_chars(at, end, um);
    const bool is_number = error == std::errc() && std::abs(um) <= kMost_um && (next == end || *next == ' ');
    if (!is_number || numbers / 2 >= telemetry::NeedleShape::kMostSpans) break;
    shape.beside_mm[numbers / 2][numbers % 2] = static_cast<float>(um / kMicrometres);
    ++numbers;
    at = next == end ? end : next + 1;
  }
  if (at != end || numbers % 2 != 0 || !std::isfinite(time_s))
    throw soci::soci_error("a shape of the needle is invalid");
  shape.spans = static_cast<std::uint8_t>(numbers / 2);
  return shape;
}

}  // namespace

std::string shape_schema() {
  return "CREATE TABLE needle_shape (time_s REAL NOT NULL, beside_um TEXT NOT NULL, PRIMARY KEY (time_s)) WITHOUT "
         "ROWID";
}

void ShapeBuffer::add(const telemetry::NeedleShape& shape) {
  if (!is_storable(shape) || shape.time_s <= last_s_) return;
  last_s_ = shape.time_s;
  times_s_.push_back(shape.time_s);
  points_um_.push_back(to_text(shape));
}

void ShapeBuffer::write(soci::session& database) {
  if (is_empty()) return;
  soci::statement insert =
      (database.prepare << "INSERT INTO needle_shape (time_s, beside_um) VALUES (:time_s, :beside_um)",
       soci::use(times_s_), soci::use(points_um_));
  insert.execute(true);
}

void ShapeBuffer::clear() noexcept {
  times_s_.clear();
  points_um_.clear();
}

std::vector<telemetry::NeedleShape> read_shapes(soci::session& database) {
  std::vector<telemetry::NeedleShape> shapes;
  std::vector<double> times_s(kShapesAFetch);
  std::vector<std::string> points_um(kShapesAFetch);
  soci::statement select =
      (database.prepare << fmt::format("SELECT time_s, substr(beside_um, 1, {}) FROM needle_shape ORDER BY time_s",
                                       kMostText + 1),
       soci::into(times_s), soci::into(points_um));
  select.execute();
  while (select.fetch()) {
    if (shapes.size() > kMaxShapeRows) throw soci::soci_error("too many shapes of the needle");
    for (std::size_t i = 0; i < times_s.size(); ++i) shapes.push_back(to_shape(times_s[i], points_um[i]));
    times_s.resize(kShapesAFetch);
    points_um.resize(kShapesAFetch);
  }
  return shapes;
}

}  // namespace trocar::storage::detail
