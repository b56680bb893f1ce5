#include "metrics/pose_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "config/csv.h"
#include "core/files/input_file.h"
#include "core/text.h"
#include "geometry/pose.h"
#include "metrics/detail/pose_events.h"
#include "telemetry/tick_fields.h"

namespace trocar::metrics {
namespace {

constexpr std::uint64_t kMostBytes = 256ULL << 20;
constexpr const char* kAdvice = "docs/metrics.md describes the columns";
constexpr const char* kNumberAdvice = "write numbers with a decimal point, and leave a missing value empty";
constexpr const char* kFieldAdvice = "put commas between the fields of a row, and decimal points into numbers";
constexpr const char* kEventAdvice = "docs/metrics.md lists the events; rename the column if it means something else";
constexpr double kMm_per_m = 1000.0;
constexpr double kUnitTolerance = 1e-2;

constexpr std::array kTip{"tip_x", "tip_y", "tip_z"};
constexpr std::array kRestTip{"rest_tip_x", "rest_tip_y", "rest_tip_z"};
constexpr std::array kRestAxis{"rest_axis_x", "rest_axis_y", "rest_axis_z"};
constexpr std::array kAxis{"axis_x", "axis_y", "axis_z"};
constexpr std::array kProbe{"probe_x", "probe_y", "probe_z"};
constexpr std::array kProbeTurn{"probe_qw", "probe_qx", "probe_qy", "probe_qz"};
/// Forces of `trocar session export` that make up the resistance along the needle.
constexpr std::array kForces{"f_prepuncture_n", "f_friction_n",    "f_cutting_n",    "f_body_axial_n",
                             "f_tip_proxy_x_n", "f_tip_proxy_y_n", "f_tip_proxy_z_n"};

}  // namespace

namespace detail {

/// A column with a number, and what makes it mm.
struct PoseColumn {
  std::size_t index = 0;
  double scale = 1.0;
  std::string name;
};

template <std::size_t count>
using PoseColumns = std::array<PoseColumn, count>;

struct PoseLayout {
  std::size_t fields = 0;
  PoseColumn time;
  PoseColumns<3> tip, axis;
  std::optional<PoseColumn> depth, force, contact;
  std::optional<PoseColumns<3>> probe, rest_tip, rest_axis;
  std::optional<PoseColumns<4>> probe_turn;
  std::optional<PoseColumns<kForces.size()>> forces;
  std::optional<PoseColumn> pressed;  ///< Of a layer that has not given way.
  std::optional<std::size_t> phase, event;
};

}  // namespace detail

namespace {

using detail::PoseColumn;
using detail::PoseColumns;
using detail::PoseLayout;

/// Finds columns by name.
class Header {
 public:
  Header(std::vector<std::string> names, std::string where) : names_(std::move(names)), where_(std::move(where)) {}

  std::optional<std::size_t> find(std::string_view name) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) return std::nullopt;
    return static_cast<std::size_t>(found - names_.begin());
  }
  std::optional<PoseColumn> find_number(const std::string& name) const {
    if (const auto index = find(name)) return PoseColumn{*index, 1.0, name};
    return std::nullopt;
  }
  /// NAME_mm or NAME_m.
  std::optional<PoseColumn> find_length(const std::string& name) const {
    // Both: check_twice.
    if (const auto index = find(name + "_mm")) return PoseColumn{*index, 1.0, name + "_mm"};
    if (const auto index = find(name + "_m")) return PoseColumn{*index, kMm_per_m, name + "_m"};
    return std::nullopt;
  }
  /// All columns of a group or none. Error: some are missing.
  template <std::size_t count>
  Result<std::optional<PoseColumns<count>>> find_group(const std::array<const char*, count>& names,
                                                       bool is_length) const {
    PoseColumns<count> columns;
    std::string missing;
    std::size_t found = 0;
    for (std::size_t n = 0; n < count; ++n) {
      const auto column = is_length ? find_length(names[n]) : find_number(names[n]);
      if (!column) {
        missing += (missing.empty() ? "" : ", ") + std::string(names[n]) + (is_length ? "_mm" : "");
        continue;
      }
      columns[n] = *column;
      ++found;
    }
    if (found == count) return std::optional(columns);
    if (found == 0) return std::optional<PoseColumns<count>>();
    return fail("line 1: missing column " + missing, where_, kAdvice);
  }
  template <std::size_t count>
  Result<PoseColumns<count>> need_group(const std::array<const char*, count>& names, bool is_length) const {
    TROCAR_TRY(const auto group, find_group(names, is_length));
    if (group) return *group;
    return fail(fmt::format("line 1: missing column {}{}", names[0], is_length ? "_mm" : ""), where_, kAdvice);
  }
  Status check_twice() const {
    for (std::size_t n = 0; n < names_.size(); ++n)
      if (!names_[n].empty() && find(names_[n]) != n)
        return fail(fmt::format("line 1: column {} occurs twice", names_[n]), where_, "remove one");
    for (const std::string& name : names_)
      if (name.ends_with("_mm") && find(name.substr(0, name.size() - 1)) && is_length(name.substr(0, name.size() - 3)))
        return fail(fmt::format("line 1: columns {} and {} are the same", name, name.substr(0, name.size() - 1)),
                    where_, "keep one of mm and m");
    return {};
  }
  std::size_t size() const noexcept { return names_.size(); }

 private:
  static bool is_length(std::string_view name) {
    return name == "depth" || std::ranges::find(kTip, name) != kTip.end() ||
           std::ranges::find(kProbe, name) != kProbe.end() || std::ranges::find(kRestTip, name) != kRestTip.end();
  }

  std::vector<std::string> names_;
  std::string where_;
};

Result<PoseLayout> find_layout(const Header& header, const std::string& where) {
  TROCAR_TRY_STATUS(header.check_twice());
  PoseLayout layout;
  layout.fields = header.size();
  const auto time = header.find_number("time_s");
  if (!time) return fail("line 1: missing column time_s", where, header.size() > 1 ? kAdvice : kFieldAdvice);
  layout.time = *time;
  TROCAR_TRY(layout.tip, header.need_group(kTip, true));
  TROCAR_TRY(layout.axis, header.need_group(kAxis, false));
  TROCAR_TRY(layout.rest_tip, header.find_group(kRestTip, true));
  TROCAR_TRY(layout.rest_axis, header.find_group(kRestAxis, false));
  TROCAR_TRY(layout.probe, header.find_group(kProbe, true));
  TROCAR_TRY(layout.probe_turn, header.find_group(kProbeTurn, false));
  if (layout.probe.has_value() != layout.probe_turn.has_value())
    return fail(fmt::format("line 1: missing column {}", layout.probe ? "probe_qw" : "probe_x_mm"), where, kAdvice);
  layout.depth = header.find_length("depth");
  layout.force = header.find_number("force_n");
  layout.contact = header.find_number("probe_contact_n");
  if (!layout.force && header.find("f_prepuncture_n")) {
    TROCAR_TRY(layout.forces, header.find_group(kForces, false));
  }
  layout.pressed = header.find_number("layer_displacement_mm");
  layout.phase = header.find("phase");
  layout.event = header.find("event");
  return layout;
}

using Fields = std::vector<std::string>;

std::string_view trimmed(std::string_view text) noexcept {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// Reads the values of one row; keeps the first fault.
class RowReader {
 public:
  explicit RowReader(const Fields& fields) : fields_(fields) {}

  /// NaN for an empty field and for "nan".
  double number(const PoseColumn& column) {
    const std::string_view text = trimmed(fields_[column.index]);
    if (text.empty() || text == "nan" || text == "-nan") return std::numeric_limits<double>::quiet_NaN();
    if (const auto value = parse_number<double>(text)) return *value * column.scale;
    refuse(column.name, fmt::format("'{}' is not a number", text.substr(0, 40)), kNumberAdvice);
    return 0.0;
  }
  std::optional<double> number(const std::optional<PoseColumn>& column) {
    if (!column) return std::nullopt;
    const double value = number(*column);
    return std::isnan(value) ? std::nullopt : std::optional(value);
  }
  Vec3 vector(const PoseColumns<3>& columns) { return {number(columns[0]), number(columns[1]), number(columns[2])}; }
  std::string_view text(std::size_t column) const { return trimmed(fields_[column]); }

  void refuse(std::string_view column, const std::string& what, const char* advice) {
    if (!fault_.empty()) return;
    fault_ = fmt::format("column {}: {}", column, what);
    advice_ = advice;
  }
  const std::string& fault() const noexcept { return fault_; }
  const char* advice() const noexcept { return advice_; }

 private:
  const Fields& fields_;
  std::string fault_;
  const char* advice_ = kAdvice;
};

std::optional<Pose> read_probe(RowReader& reader, const PoseLayout& layout) {
  if (!layout.probe) return std::nullopt;
  const Vec3 p_P = reader.vector(*layout.probe);
  const auto& turn = *layout.probe_turn;
  const Eigen::Quaterniond q =
      from_wxyz({reader.number(turn[0]), reader.number(turn[1]), reader.number(turn[2]), reader.number(turn[3])});
  if (!p_P.allFinite() || !q.coeffs().allFinite()) return std::nullopt;
  if (std::abs(q.norm() - 1.0) > kUnitTolerance) {
    reader.refuse("probe_qw", "the quaternion's length is not 1", kAdvice);
    return std::nullopt;
  }
  return Pose(q.normalized().toRotationMatrix(), p_P);
}

std::optional<double> read_resistance(RowReader& reader, const PoseLayout& layout, const Vec3& axis_P) {
  if (layout.force) return reader.number(layout.force);
  if (!layout.forces) return std::nullopt;
  const auto& forces = *layout.forces;
  telemetry::TickSample sample;
  sample.axis = axis_P;
  sample.f_prepuncture_n = reader.number(forces[0]);
  sample.f_friction_n = reader.number(forces[1]);
  sample.f_cutting_n = reader.number(forces[2]);
  sample.f_body_axial_n = reader.number(forces[3]);
  sample.f_tip_proxy_n = {reader.number(forces[4]), reader.number(forces[5]), reader.number(forces[6])};
  const double resistance_n = telemetry::axial_resistance_n(sample);
  return std::isfinite(resistance_n) ? std::optional(resistance_n) : std::nullopt;
}

/// As moment_of(TickSample).
double read_pressed_mm(RowReader& reader, const PoseLayout& layout, const Moment& moment) {
  telemetry::TickSample sample;
  sample.layer_displacement_mm = reader.number(layout.pressed).value_or(0.0);
  if (!layout.pressed || !moment.phase) return 0.0;
  sample.phase = *moment.phase;
  sample.rest_tip_mm = moment.tip_A();
  sample.rest_axis = moment.axis_A().normalized();
  return (sample.rest_tip_mm - telemetry::pierced_rest_tip_mm(sample)).norm();
}

}  // namespace

struct PoseTable::Impl {
  std::string text;
  std::string where;
  PoseLayout layout;
  std::vector<std::string> layers;
  std::size_t rows = 0;

  /// `names` grows by unknown layers.
  static void read_events(RowReader& reader, std::string_view field, std::vector<std::string>& names, Moment& moment) {
    constexpr std::size_t kMostLayers = 255;
    const detail::PoseEvents read = detail::read_pose_events(field);
    if (!read.fault.empty()) return reader.refuse("event", read.fault, kEventAdvice);
    telemetry::TickEvents events{};
    if (read.punctures.size() > events.size())
      return reader.refuse("event", fmt::format("more than {} punctures in a row", events.size()),
                           "give each the row of its time");
    for (std::size_t n = 0; n < read.punctures.size(); ++n) {
      const std::string name(read.punctures[n]);
      auto found = std::find(names.begin(), names.end(), name);
      if (found == names.end() && names.size() == kMostLayers)
        return reader.refuse("event", fmt::format("more than {} names of layers", kMostLayers), kEventAdvice);
      if (found == names.end()) found = names.insert(names.end(), name);
      events[n] = {telemetry::EventKind::kPuncture, static_cast<std::uint8_t>(found - names.begin())};
    }
    moment.events = events;
    moment.is_paused = read.is_paused;
  }

  static void read_phase(RowReader& reader, std::string_view field, Moment& moment) {
    if (field.empty()) return;
    for (int n = 0; n <= static_cast<int>(telemetry::kLastInsertionPhase); ++n)
      if (const auto phase = static_cast<telemetry::InsertionPhase>(n); field == to_string(phase)) moment.phase = phase;
    if (!moment.phase)
      reader.refuse("phase", fmt::format("'{}' is no phase", field.substr(0, 40)),
                    "use outside, loading, inserted or retracting, or leave it empty");
  }

  Moment read_row(RowReader& reader, std::vector<std::string>& names) const {
    Moment moment;
    moment.time_s = reader.number(layout.time);
    if (std::isnan(moment.time_s))
      reader.refuse(layout.time.name, "a row has no time", "remove the row, or give its time");
    moment.tip_P = reader.vector(layout.tip);
    moment.axis_P = reader.vector(layout.axis);
    if (layout.rest_tip) moment.rest_tip_A = reader.vector(*layout.rest_tip);
    if (layout.rest_axis) moment.rest_axis_A = reader.vector(*layout.rest_axis);
    moment.depth_mm = reader.number(layout.depth);
    moment.resistance_n = read_resistance(reader, layout, moment.axis_P);
    moment.X_PT = read_probe(reader, layout);
    moment.contact_n = reader.number(layout.contact);
    if (layout.phase) read_phase(reader, reader.text(*layout.phase), moment);
    if (layout.event) read_events(reader, reader.text(*layout.event), names, moment);
    if (names.empty()) moment.events.reset();  // no row has a puncture: the recording does not know them
    moment.pressed_mm = read_pressed_mm(reader, layout, moment);
    return moment;
  }

  /// Visits every row after the header. Errors: see read().
  Status walk(std::vector<std::string>& names, const std::function<void(const Moment&)>& visit) const {
    config::CsvReader rows(text, where);
    config::CsvRow row;
    TROCAR_TRY_STATUS(rows.next(row));  // the header
    double last_s = -std::numeric_limits<double>::infinity();
    while (true) {
      TROCAR_TRY(const bool has_row, rows.next(row));
      if (!has_row) return {};
      const auto refuse = [&](const std::string& what, const char* advice) {
        return fail(fmt::format("line {}: {}", row.line, what), where, advice);
      };
      if (row.fields.size() != layout.fields)
        return refuse(fmt::format("{} fields, the header has {}", row.fields.size(), layout.fields), kFieldAdvice);
      RowReader reader(row.fields);
      const Moment moment = read_row(reader, names);
      if (!reader.fault().empty()) return refuse(reader.fault(), reader.advice());
      if (moment.time_s < last_s)
        return refuse(fmt::format("column time_s: {} s is before the line above ({} s)", moment.time_s, last_s),
                      "sort the rows by time");
      last_s = moment.time_s;
      visit(moment);
    }
  }
};

PoseTable::PoseTable(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
PoseTable::PoseTable(PoseTable&&) noexcept = default;
PoseTable& PoseTable::operator=(PoseTable&&) noexcept = default;
PoseTable::~PoseTable() = default;

Result<PoseTable> PoseTable::read(const std::filesystem::path& path) {
  auto impl = std::make_unique<Impl>();
  impl->where = path.string();
  TROCAR_TRY(const InputFile file, InputFile::open(path, FileLimit{FileKind::kOther, "table of poses", kMostBytes}));
  TROCAR_TRY(impl->text, file.read_all());
  if (impl->text.empty()) return fail("the file is empty", impl->where, kAdvice);
  config::CsvRow header;
  TROCAR_TRY_STATUS(config::CsvReader(impl->text, impl->where).next(header));
  for (std::string& name : header.fields) name = std::string(trimmed(name));
  TROCAR_TRY(impl->layout, find_layout(Header(std::move(header.fields), impl->where), impl->where));
  std::size_t rows = 0;
  TROCAR_TRY_STATUS(impl->walk(impl->layers, [&](const Moment&) { ++rows; }));
  if (rows == 0) return fail("the table has no row of poses", impl->where, kAdvice);
  impl->rows = rows;
  return PoseTable(std::move(impl));
}

const std::vector<std::string>& PoseTable::layer_names() const noexcept {
  return impl_->layers;
}
std::size_t PoseTable::rows() const noexcept {
  return impl_->rows;
}
void PoseTable::walk(const std::function<void(const Moment&)>& visit) const {
  std::vector<std::string> names = impl_->layers;
  (void)impl_->walk(names, visit);  // read() found no error in the same text
}

}  // namespace trocar::metrics
