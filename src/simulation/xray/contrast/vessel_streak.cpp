#include "xray/contrast/vessel_streak.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/random.h"

namespace trocar::xray {
namespace {

constexpr double kSameStream_mm = 1.0;  ///< A tip that moves less injects into the same stream.
constexpr double kHeartbeat_s = 1.0;    ///< The way follows the mean flow over this time,
constexpr int kMoments = 8;             ///< at this many moments.
constexpr int kRing = 6;                ///< Strands in each of two rings around the middle one,
/// whose offsets are between two limits, and whose radii have a limit; all relative to the stream's radius.
constexpr std::array<std::array<double, 3>, 2> kRings{{{0.4, 0.6, 0.5}, {0.72, 0.85, 0.3}}};
constexpr double kStreakPiece_mm = 2.0;   ///< Length of the pieces.
constexpr double kLeastLength_mm = 0.5;   ///< Of a strand.
constexpr double kLeastSwept_mm3 = 1e-4;  ///< Of a portion that does not move.
constexpr double kLeastSpeed_mm_per_s = 1e-3;

Vec3 offset_P(const detail::VesselCourse::Station& station, double mm, double angle) {
  return station.p_P + mm * (std::cos(angle) * station.u_P + std::sin(angle) * station.w_P);
}

}  // namespace

VesselStreak::VesselStreak(std::shared_ptr<const anatomy::VirtualPatient> patient, const VesselParams& params,
                           BloodVelocity blood)
    : patient_(std::move(patient)), params_(params), blood_(std::move(blood)) {}

bool VesselStreak::is_vessel(const Vec3& p_P) const {
  const anatomy::Label* label = anatomy::find_label(*patient_, p_P);
  return label != nullptr && label->tissue == "vessel";
}

Vec3 VesselStreak::velocity(const Vec3& p_P, double time_s) const {
  const Vec3 v_P = blood_ ? blood_(p_P, time_s) : Vec3::Zero();
  return v_P.allFinite() ? v_P : Vec3::Zero();
}

VesselStreak::Stream VesselStreak::make_stream(const Vec3& tip_P) const {
  const auto mean_velocity = [this](const Vec3& p_P) {
    Vec3 sum = Vec3::Zero();
    for (int n = 0; n < kMoments; ++n) sum += velocity(p_P, time_s_ + kHeartbeat_s * n / kMoments);
    return Vec3(sum / kMoments);
  };
  Stream stream;
  stream.tip_P = tip_P;
  stream.course = detail::find_vessel_course(
      tip_P, [this](const Vec3& p_P) { return is_vessel(p_P); }, mean_velocity, params_.fan_slope);
  Random random(static_cast<std::uint64_t>(std::llround(1e3 * time_s_)));
  stream.strands.push_back({0.0, 0.0, 0.5, {}, {}});
  for (const auto& [low, high, most] : kRings)
    for (int n = 0; n < kRing; ++n) {
      const double offset = random.uniform(low, high);
      const double angle = 2.0 * std::numbers::pi * (n + random.uniform(-0.3, 0.3)) / kRing;
      stream.strands.push_back({offset, angle, std::min(1.0 - offset, most), {}, {}});
    }
  stream.section = 0.0;
  for (const Strand& strand : stream.strands) stream.section += strand.radius * strand.radius;
  return stream;
}

void VesselStreak::forget_speeds(Stream& stream) const {
  for (Strand& strand : stream.strands)
    strand.speed_mm_per_s.assign(stream.course.stations.size(), std::numeric_limits<double>::quiet_NaN());
}

/// Blood at the strand, and the injected volume: it pushes the blood of the whole lumen, and near the tip moves at
/// least as fast as its own section demands.
double VesselStreak::speed_mm_per_s(const Stream& stream, Strand& strand, std::size_t station) const {
  double& speed = strand.speed_mm_per_s[station];
  if (!std::isnan(speed)) return speed;
  const detail::VesselCourse::Station& at = stream.course.stations[station];
  const Vec3 p_P = offset_P(at, strand.offset * at.stream_mm, strand.angle);
  speed = velocity(p_P, time_s_).dot(at.along_P);
  const double down = stream.course.first_mm + detail::VesselCourse::kStep_mm * static_cast<double>(station);
  if (down >= 0.0 && stream.mm3_per_s > 0.0) {
    const double pushed = stream.mm3_per_s / (std::numbers::pi * at.lumen_mm * at.lumen_mm);
    const double own =
        stream.mm3_per_s / (std::numbers::pi * at.stream_mm * at.stream_mm * std::min(stream.section, 1.0));
    speed = std::max(speed + pushed, own);
  }
  return speed;
}

/// Place after a time: across each step of the way with the speed there.
double VesselStreak::moved_mm(const Stream& stream, Strand& strand, double place_mm, double dt_s) const {
  const double first_mm = stream.course.first_mm, last_mm = stream.course.last_mm();
  bool is_down = true;
  for (double left_s = dt_s; left_s > 0.0;) {
    const double x = (place_mm - first_mm) / detail::VesselCourse::kStep_mm;
    const auto station = static_cast<std::size_t>(
        std::clamp(std::floor(x + 1e-9), 0.0, static_cast<double>(stream.course.stations.size() - 1)));
    const double speed = speed_mm_per_s(stream, strand, station);
    if (std::abs(speed) < kLeastSpeed_mm_per_s) break;
    // A place between two stations with opposite speeds stays.
    if (left_s < dt_s && (speed > 0.0) != is_down) break;
    is_down = speed > 0.0;
    const double floor_mm = first_mm + detail::VesselCourse::kStep_mm * static_cast<double>(station);
    double next_mm = is_down ? floor_mm + detail::VesselCourse::kStep_mm : floor_mm;
    if (!is_down && place_mm - floor_mm < 1e-6) next_mm = floor_mm - detail::VesselCourse::kStep_mm;
    next_mm = std::clamp(next_mm, first_mm, last_mm);
    const double needed_s = (next_mm - place_mm) / speed;
    if (needed_s <= 0.0) break;  // an end of the way
    if (needed_s > left_s) return place_mm + left_s * speed;
    place_mm = next_mm;
    left_s -= needed_s;
  }
  return place_mm;
}

void VesselStreak::inject(const Vec3& tip_P, double dt_s, double ml, double iodine_mg_per_ml) {
  if (streams_.empty() || (streams_.back().tip_P - tip_P).norm() > kSameStream_mm)
    streams_.push_back(make_stream(tip_P));
  Stream& stream = streams_.back();
  stream.mm3_per_s = ml * kMm3PerMl / dt_s;
  forget_speeds(stream);
  // By the volume that each strand fills, so that all have the same concentration.
  const double tip_mm3 = stream.course.at(0.0).swept_mm3;
  std::vector<double> heads_mm, weights;
  double sum = 0.0;
  for (Strand& strand : stream.strands) {
    heads_mm.push_back(std::max(moved_mm(stream, strand, 0.0, dt_s), 0.0));
    weights.push_back(strand.radius * strand.radius *
                      std::max(stream.course.at(heads_mm.back()).swept_mm3 - tip_mm3, kLeastSwept_mm3));
    sum += weights.back();
  }
  for (std::size_t n = 0; n < stream.strands.size(); ++n)
    stream.strands[n].portions.push_back({0.0, heads_mm[n], ml * iodine_mg_per_ml * weights[n] / sum, 0.0});
}

void VesselStreak::move(Stream& stream, double dt_s) {
  const double kept = std::exp(-dt_s / params_.washout_s);
  const double last_mm = stream.course.last_mm();
  for (Strand& strand : stream.strands) {
    for (Portion& portion : strand.portions) {
      portion.age_s += dt_s;
      double rest_mg = portion.iodine_mg * kept;
      portion.tail_mm = moved_mm(stream, strand, portion.tail_mm, dt_s);
      // At the vessel's end the head waits for the tail.
      portion.head_mm = std::max(moved_mm(stream, strand, portion.head_mm, dt_s), portion.tail_mm);
      const bool is_at_end = portion.tail_mm >= last_mm && last_mm > 0.0;
      if (is_at_end || portion.age_s > params_.longest_s) rest_mg = 0.0;
      washed_away_mg_ += portion.iodine_mg - rest_mg;
      portion.iodine_mg = rest_mg;
    }
    std::erase_if(strand.portions, [](const Portion& portion) { return portion.iodine_mg <= 0.0; });
  }
}

void VesselStreak::step(double dt_s) {
  for (Stream& stream : streams_) {
    forget_speeds(stream);
    move(stream, dt_s);
    stream.mm3_per_s = 0.0;  // until the next portion
  }
  std::erase_if(streams_, [](const Stream& stream) {
    return std::all_of(stream.strands.begin(), stream.strands.end(),
                       [](const Strand& strand) { return strand.portions.empty(); });
  });
  time_s_ += dt_s;
}

double VesselStreak::iodine_mg() const {
  double sum = 0.0;
  for (const Stream& stream : streams_)
    for (const Strand& strand : stream.strands)
      for (const Portion& portion : strand.portions) sum += portion.iodine_mg;
  return sum;
}

/// Distributes the portions to pieces of equal length along the way.
void VesselStreak::add_pieces_of(const Stream& stream, const Strand& strand, double least_mg_per_ml,
                                 std::vector<IodinePiece>& pieces) {
  if (strand.portions.empty()) return;
  double first_mm = strand.portions.front().tail_mm, last_mm = strand.portions.front().head_mm;
  for (const Portion& portion : strand.portions) {
    first_mm = std::min(first_mm, portion.tail_mm);
    last_mm = std::max(last_mm, portion.head_mm);
  }
  if (last_mm - first_mm < kLeastLength_mm) first_mm = last_mm - kLeastLength_mm;
  const auto count = static_cast<std::size_t>(std::ceil((last_mm - first_mm) / kStreakPiece_mm));
  const double piece_mm = (last_mm - first_mm) / static_cast<double>(count);
  std::vector<double> mg(count, 0.0);
  for (const Portion& portion : strand.portions) {
    // A portion has the same concentration all along.
    const auto swept = [&](double place_mm) { return stream.course.at(place_mm).swept_mm3; };
    const double all_mm3 = swept(portion.head_mm) - swept(portion.tail_mm);
    const auto bin = [&](double place_mm) {
      return std::min(static_cast<std::size_t>(std::max((place_mm - first_mm) / piece_mm, 0.0)), count - 1);
    };
    const std::size_t from = bin(portion.tail_mm), to = bin(portion.head_mm);
    if (from == to || all_mm3 <= kLeastSwept_mm3) {
      mg[from] += portion.iodine_mg;
      continue;
    }
    for (std::size_t n = from; n <= to; ++n) {
      const double low = n == from ? portion.tail_mm : first_mm + piece_mm * static_cast<double>(n);
      const double high = n == to ? portion.head_mm : first_mm + piece_mm * static_cast<double>(n + 1);
      mg[n] += portion.iodine_mg * (swept(high) - swept(low)) / all_mm3;
    }
  }
  const auto place = [&](std::size_t n) { return stream.course.at(first_mm + piece_mm * static_cast<double>(n)); };
  detail::VesselCourse::Station before = place(0);
  for (std::size_t n = 0; n < count; ++n) {
    const detail::VesselCourse::Station after = place(n + 1);
    IodinePiece piece{offset_P(before, strand.offset * before.stream_mm, strand.angle),
                      offset_P(after, strand.offset * after.stream_mm, strand.angle), strand.radius * before.stream_mm,
                      strand.radius * after.stream_mm, 0.0};
    const double length_mm = (piece.b_P - piece.a_P).norm();
    if (length_mm < kLeastLength_mm * 0.5) piece.b_P = piece.a_P + kLeastLength_mm * 0.5 * after.along_P;
    const double a = piece.radius_a_mm, b = piece.radius_b_mm;
    const double ml = std::numbers::pi / 3.0 * (a * a + a * b + b * b) * (piece.b_P - piece.a_P).norm() / kMm3PerMl;
    piece.iodine_mg_per_ml = mg[n] / ml;
    if (piece.iodine_mg_per_ml >= least_mg_per_ml) pieces.push_back(piece);
    before = after;
  }
}

void VesselStreak::add_pieces(double least_mg_per_ml, std::vector<IodinePiece>& pieces) const {
  for (const Stream& stream : streams_)
    for (const Strand& strand : stream.strands) add_pieces_of(stream, strand, least_mg_per_ml, pieces);
}

}  // namespace trocar::xray
