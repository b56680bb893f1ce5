#include "phantom/section_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace trocar::phantom {

Status ReadState::finish() const {
  if (first_) return tl::unexpected(*first_);
  for (const auto& section : sections_)
    TROCAR_TRY_STATUS(section->table.check_keys({section->keys.begin(), section->keys.end()}));
  return {};
}

SectionReader::SectionReader(config::TomlTable table, ReadState& state) : state_(&state) {
  state.sections_.push_back(std::make_unique<ReadState::Section>());
  section_ = state.sections_.back().get();
  section_->table = std::move(table);
}

SectionReader SectionReader::section(std::string_view key) {
  section_->keys.emplace_back(key);
  return {take(section_->table.table(key), config::TomlTable()), *state_};
}

void SectionReader::refuse(std::string_view key, std::string what, std::string advice) {
  state_->add({std::move(what), fmt::format("{}.{}", section_->table.where(), key), std::move(advice)});
}

float SectionReader::radians(float degrees) {
  return degrees * std::numbers::pi_v<float> / 180.0F;
}

std::vector<double> SectionReader::read(std::string_view key, std::size_t count, config::Range range) {
  section_->keys.emplace_back(key);
  const std::vector<double> zeros(count);
  if (count == 1) return {take(section_->table.number(key, range), 0.0)};
  std::vector<double> values = take(section_->table.numbers(key, range), zeros);
  if (values.size() == count) return values;
  refuse(key, fmt::format("has {} numbers, not {}", values.size(), count), "correct the list");
  return zeros;
}

void SectionReader::check_length(std::string_view key, float value) {
  const auto mm = static_cast<double>(value);
  if (mm < kLengths.low || mm > kLengths.high)
    refuse(key, fmt::format("the length {} is not above 0", mm), "give a length in mm");
}

int SectionReader::integer(std::string_view key, config::Range range) {
  section_->keys.emplace_back(key);
  return static_cast<int>(take(section_->table.integer(key, range), std::int64_t{0}));
}

std::array<double, 3> SectionReader::spreads(std::string_view key) {
  const std::vector<double> values = read(key, 3, {0.0, 1000.0});
  return {values[0], values[1], values[2]};
}

Vec3f SectionReader::point(std::string_view key) {
  const auto values = numbers<3>(key);
  return {values[0], values[1], values[2]};
}

Vec3f SectionReader::radii(std::string_view key) {
  const auto values = lengths<3>(key);
  return {values[0], values[1], values[2]};
}

SeedRange SectionReader::range(std::string_view key) {
  return range(key, kCoordinates);
}

SeedRange SectionReader::size(std::string_view key) {
  return range(key, kLengths);
}

SeedRange SectionReader::range(std::string_view key, config::Range ends) {
  const std::vector<double> values = read(key, 2, ends);
  if (values[0] > values[1]) refuse(key, "the low end is above the high end", "write [low, high]");
  return {values[0], values[1]};
}

Transition SectionReader::transition(std::string_view key) {
  const auto values = numbers<2>(key);
  if (values[0] == values[1]) refuse(key, "both ends are the same", "write [from, to]");
  return {values[0], values[1]};
}

Rise SectionReader::rise(std::string_view key) {
  const auto values = numbers<3>(key);
  if (values[1] == values[2]) refuse(key, "both ends are the same", "write [height, from, to]");
  return {values[0], {values[1], values[2]}};
}

Rise SectionReader::rise_deg(std::string_view key) {
  const Rise rise = this->rise(key);
  return {rise.height, {radians(rise.over.from), radians(rise.over.to)}};
}

Hill SectionReader::hill(std::string_view key) {
  const auto values = numbers<3>(key);
  check_length(key, values[2]);
  return {values[0], values[1], values[2]};
}

Hill SectionReader::hill_deg(std::string_view key) {
  const Hill hill = this->hill(key);
  return {hill.height, radians(hill.centre), radians(hill.width)};
}

Hill SectionReader::unit_hill(std::string_view key) {
  const auto values = numbers<2>(key);
  check_length(key, values[1]);
  return {1.0F, values[0], values[1]};
}

Hill SectionReader::unit_hill_deg(std::string_view key) {
  const Hill hill = unit_hill(key);
  return {1.0F, radians(hill.centre), radians(hill.width)};
}

Ellipse SectionReader::ellipse(std::string_view key) {
  const auto values = numbers<4>(key);
  for (const std::size_t n : {2U, 3U}) check_length(key, values[n]);
  return {values[0], values[1], values[2], values[3]};
}

Folds SectionReader::folds(std::string_view key) {
  const auto values = lengths<2>(key);
  return {values[0], values[1]};
}

Knot SectionReader::knot(std::string_view key) {
  const auto values = numbers<4>(key);
  check_length(key, values[3]);
  return {Vec3f(values[0], values[1], values[2]), values[3]};
}

Course SectionReader::course(std::string_view key) {
  Course course;
  for (const std::vector<double>& row : rows(key, 4)) {
    const auto values = to_array<4>(row);
    check_length(key, values[3]);
    course.push_back({Vec3f(values[0], values[1], values[2]), values[3]});
  }
  if (course.size() < 2) refuse(key, "a course needs two knots", "add [x, y, z, radius]");
  return course;
}

std::vector<Cone> SectionReader::cones(std::string_view key) {
  std::vector<Cone> cones;
  for (const std::vector<double>& row : rows(key, 8)) {
    const auto values = to_array<8>(row);
    for (const std::size_t n : {3U, 7U}) check_length(key, values[n]);
    cones.push_back(
        {Vec3f(values[0], values[1], values[2]), Vec3f(values[4], values[5], values[6]), values[3], values[7]});
  }
  return cones;
}

std::vector<std::vector<double>> SectionReader::rows(std::string_view key, std::size_t columns) {
  section_->keys.emplace_back(key);
  auto rows = take(section_->table.rows(key, columns, kCoordinates), {});
  if (rows.empty() || rows.size() > kMaxRows)
    refuse(key, fmt::format("has {} rows, not 1 to {}", rows.size(), kMaxRows), "correct the list");
  return rows;
}

}  // namespace trocar::phantom
