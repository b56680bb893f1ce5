#include "storage/detail/parameters_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>

#include "storage/detail/database.h"

namespace trocar::storage::detail {
namespace {

constexpr char kBetweenSettings = ';', kBetweenOptions = '\n';

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

}  // namespace

std::vector<std::string> parameters_schema() {
  return {
      "CREATE TABLE parameters (tick INTEGER PRIMARY KEY, time_s REAL NOT NULL, settings TEXT NOT NULL, options TEXT "
      "NOT NULL, tissue_table_toml TEXT NOT NULL)",
      "CREATE TABLE interruptions (tick INTEGER NOT NULL, from_s REAL NOT NULL, to_s REAL NOT NULL, reason TEXT NOT "
      "NULL)"};
}

std::string parameters_events_sql() {
  return "SELECT printf('interruption:%.3f', to_s - from_s) AS text FROM interruptions i WHERE i.tick = t.tick "
         "UNION ALL SELECT 'set:' || replace(settings, ';', ';set:') FROM parameters p WHERE p.tick = t.tick AND "
         "settings <> ''";
}

void ParametersBuffer::write(soci::session& database) {
  for (const SessionParameters& row : parameters_) {
    const int tick = static_cast<int>(row.tick);
    const std::string settings = fmt::format("{}", fmt::join(row.settings, ";"));
    const std::string options = fmt::format("{}", fmt::join(row.options, "\n"));
    database << "INSERT INTO parameters (tick, time_s, settings, options, tissue_table_toml) VALUES (:tick, :time, "
                ":settings, :options, :table)",
        soci::use(tick), soci::use(row.time_s), soci::use(settings), soci::use(options),
        soci::use(row.tissue_table_toml);
  }
  for (const auto& [interruption, first] : interruptions_) {
    const int tick = static_cast<int>(first);
    database << "INSERT INTO interruptions (tick, from_s, to_s, reason) VALUES (:tick, :from, :to, :reason)",
        soci::use(tick), soci::use(interruption.from_s), soci::use(interruption.to_s), soci::use(interruption.reason);
  }
}

void ParametersBuffer::clear() noexcept {
  parameters_.clear();
  interruptions_.clear();
}

std::vector<SessionParameters> read_parameters(soci::session& database, std::size_t tick_count) {
  std::vector<SessionParameters> all;
  if (!has_table(database, "parameters")) return all;
  int tick = 0;
  SessionParameters row;
  std::string settings, options;
  soci::statement select =
      (database.prepare << "SELECT tick, time_s, settings, options, tissue_table_toml FROM parameters ORDER BY tick",
       soci::into(tick), soci::into(row.time_s), soci::into(settings), soci::into(options),
       soci::into(row.tissue_table_toml));
  select.execute();
  std::size_t bytes = 0;
  while (select.fetch()) {
    bytes += settings.size() + options.size() + row.tissue_table_toml.size();
    if (bytes > kMaxParameterBytes || all.size() >= kMaxChanges)
      throw soci::soci_error("the changes of parameters are too long");
    if (tick < 0 || static_cast<std::size_t>(tick) >= tick_count || !std::isfinite(row.time_s))
      throw soci::soci_error("a change of parameters is out of range");
    row.tick = static_cast<std::size_t>(tick);
    row.settings = split(settings, kBetweenSettings);
    row.options = split(options, kBetweenOptions);
    all.push_back(row);
  }
  return all;
}

std::vector<tasks::Interruption> read_interruptions(soci::session& database) {
  std::vector<tasks::Interruption> all;
  if (!has_table(database, "interruptions")) return all;
  tasks::Interruption row;
  soci::statement select = (database.prepare << "SELECT from_s, to_s, reason FROM interruptions ORDER BY from_s",
                            soci::into(row.from_s), soci::into(row.to_s), soci::into(row.reason));
  select.execute();
  while (select.fetch()) {
    if (!std::isfinite(row.from_s) || !(row.to_s >= row.from_s) || row.reason.size() > kMaxNameBytes ||
        all.size() >= kMaxChanges)
      throw soci::soci_error("an interruption is out of range");
    all.push_back(row);
  }
  return all;
}

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
