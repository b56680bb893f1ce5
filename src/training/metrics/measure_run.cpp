#include "metrics/measure_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/result.h"
#include "metrics/detail/body.h"

namespace trocar::metrics {
namespace {

constexpr double kLeastAxis = 1e-6;

bool is_finite(const std::optional<double>& value) noexcept {
  return !value || std::isfinite(*value);
}

/// Removes optional parts that are not finite.
void drop_invalid_parts(Moment& moment) noexcept {
  if (!is_finite(moment.depth_mm)) moment.depth_mm.reset();
  if (!is_finite(moment.resistance_n)) moment.resistance_n.reset();
  if (!is_finite(moment.contact_n)) moment.contact_n.reset();
  if (moment.R_PN && !moment.R_PN->allFinite()) moment.R_PN.reset();
  if (moment.X_PT && !moment.X_PT->is_finite()) moment.X_PT.reset();
  if (moment.xray && !(std::isfinite(moment.xray->beam_s) && std::isfinite(moment.xray->contrast_ml) &&
                       std::isfinite(moment.xray->air_kerma_mgy) && std::isfinite(moment.xray->dose_area_gycm2)))
    moment.xray.reset();
}

Roles roles_of(const MetricContext& context) {
  Roles roles;
  if (context.task != nullptr) roles.add(Role::kTask);
  if (context.patient != nullptr) roles.add(Role::kPatient);
  if (!context.expert_paths.empty()) roles.add(Role::kExpert);
  if (context.plane) roles.add(Role::kPlane);
  return roles;
}

AttemptTrack::Facts facts_of(const MetricContext& context) {
  AttemptTrack::Facts facts{context.patient, {}, context.end_s, {}};
  const auto skin = std::ranges::find(context.layer_names, "skin");
  const auto id = skin - context.layer_names.begin();
  if (skin != context.layer_names.end() && id <= 255) facts.skin_layer = static_cast<std::uint8_t>(id);
  for (const ExpertPath& path : context.expert_paths) facts.target_points_P.push_back(path.line_P.b);
  return facts;
}

std::optional<Role> find_missing(const Roles& wanted, const Roles& given) noexcept {
  for (unsigned n = 0; n <= static_cast<unsigned>(kLastRole); ++n)
    if (const auto role = static_cast<Role>(n); wanted.has(role) && !given.has(role)) return role;
  return std::nullopt;
}

bool is_of_context(Role role) noexcept {
  return role == Role::kTask || role == Role::kPatient || role == Role::kExpert || role == Role::kPlane;
}

bool context_serves(const MetricGroup& group, const Roles& given) noexcept {
  for (unsigned n = 0; n <= static_cast<unsigned>(kLastRole); ++n) {
    const auto role = static_cast<Role>(n);
    if (is_of_context(role) && group.values.front().roles.has(role) && !given.has(role)) return false;
  }
  return true;
}

}  // namespace

MeasureRun::MeasureRun(MetricContext context)
    : context_(std::move(context)), roles_(roles_of(context_)), track_(facts_of(context_)) {
  for (const MetricGroup& group : metric_groups())
    metrics_.push_back(context_serves(group, roles_) ? group.make(context_) : nullptr);
}
MeasureRun::MeasureRun(MeasureRun&&) noexcept = default;
MeasureRun::~MeasureRun() = default;

bool MeasureRun::complete(Moment& moment) const {
  const double length = moment.axis_P.norm();
  if (!std::isfinite(moment.time_s) || !moment.tip_P.allFinite() || !(length > kLeastAxis && std::isfinite(length)))
    return false;
  if (before_ && !(moment.time_s > before_->time_s)) return false;
  moment.axis_P /= length;
  if (moment.rest_tip_A && !moment.rest_tip_A->allFinite()) return false;
  if (moment.rest_axis_A) {
    const double rest_length = moment.rest_axis_A->norm();
    if (!(rest_length > kLeastAxis && std::isfinite(rest_length))) return false;
    *moment.rest_axis_A /= rest_length;
  }
  drop_invalid_parts(moment);
  if (const anatomy::VirtualPatient* patient = context_.patient) {
    const double pierced_mm = std::max(moment.pressed_mm, detail::kInside_mm);
    moment.label =
        volume::sample_nearest<std::uint8_t>(patient->labels, moment.tip_A() - pierced_mm * moment.axis_A(), 0);
    if (!moment.depth_mm) moment.depth_mm = detail::depth_in_body_mm(*patient, moment.tip_A(), moment.axis_A());
  }
  if (moment.depth_mm) moment.depth_mm = std::max(0.0, *moment.depth_mm);
  return true;
}

void MeasureRun::note_roles(const Moment& moment) {
  if (moment.depth_mm) roles_.add(Role::kDepth);
  if (moment.events) roles_.add(Role::kEvents);
  if (moment.resistance_n) roles_.add(Role::kForce);
  if (moment.R_PN) roles_.add(Role::kRoll);
  if (moment.X_PT) roles_.add(Role::kTransducer);
  if (moment.X_PT && (moment.contact_n || context_.patient != nullptr)) roles_.add(Role::kContact);
  if (moment.xray) roles_.add(Role::kXray);
}

void MeasureRun::step(const Moment& given) {
  has_pause_ = has_pause_ || given.is_paused;
  Moment moment = given;
  if (!complete(moment)) {
    ++left_out_;
    return;
  }
  ++moments_;
  moment.is_paused = std::exchange(has_pause_, false);
  note_roles(moment);
  const bool is_joined = before_ && !moment.is_paused;
  const double dt_s = is_joined ? moment.time_s - before_->time_s : 0.0;
  active_s_ += dt_s;
  const Step step{moment, is_joined ? &*before_ : nullptr, dt_s, active_s_};
  track_.step(moment);
  for (const auto& metric : metrics_)
    if (metric) metric->step(step);
  before_ = moment;
}

RunEnd MeasureRun::end() const {
  RunEnd end;
  if (!track_.end()) return end;
  const Moment& last = track_.end()->moment;
  end.moment = last;
  if (last.depth_mm && *last.depth_mm > 0.0) {
    if (const auto& entry = track_.end()->entry) end.entry_P = track_.skin_crossing_A(*entry);
    end.inserted_P = Segment{last.tip_A() - *last.depth_mm * last.axis_A(), last.tip_A()};
  }
  double nearest_mm = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < context_.expert_paths.size(); ++n) {
    const Segment& line_P = context_.expert_paths[n].line_P;
    const double apart_mm =
        end.inserted_P ? detail::piece_distance(*end.inserted_P, line_P).mean_mm : (last.tip_A() - line_P.b).norm();
    if (apart_mm >= nearest_mm) continue;
    nearest_mm = apart_mm;
    end.expert = n;
  }
  return end;
}

void MeasureRun::report_group(std::size_t number, const RunEnd& end, std::span<MetricValue> values) const {
  const MetricGroup& group = metric_groups()[number];
  if (moments_ > 0 && metrics_[number]) metrics_[number]->report(end, values);
  for (std::size_t n = 0; n < values.size(); ++n) {
    MetricValue& value = values[n];
    const std::optional<Role> missing = find_missing(group.values[n].roles, roles_);
    if (moments_ == 0)
      value.missing = "the recording has no valid moment";
    else if (missing)
      value.missing = reason_without(*missing);
    else if (value.value && !std::isfinite(*value.value))
      value.missing = "the value is not a finite number";
    TROCAR_CHECK(value.value || !value.missing.empty());
    if (value.missing.empty()) continue;
    value.value.reset();
    value.at_s.reset();
    value.note.clear();
  }
}

std::vector<MetricValue> MeasureRun::report() const {
  const RunEnd the_end = end();
  std::vector<MetricValue> all;
  const std::span<const MetricGroup> groups = metric_groups();
  for (std::size_t n = 0; n < groups.size(); ++n) {
    const std::size_t first = all.size();
    for (const MetricDescription& description : groups[n].values)
      all.push_back({description.name, {}, description.unit, {}, {}, {}});
    report_group(n, the_end, std::span(all).subspan(first));
  }
  return all;
}

}  // namespace trocar::metrics
