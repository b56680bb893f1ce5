#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/toml.h"
#include "phantom/phantom_data.h"

namespace trocar::phantom {

/// The first error of a file of numbers, and the keys that were read, for the check of unknown keys.
class ReadState {
 public:
  void add(Error error) {
    if (!first_) first_ = std::move(error);
  }
  /// The first error, else the first unknown key.
  Status finish() const;

 private:
  friend class SectionReader;
  struct Section {
    config::TomlTable table;
    std::vector<std::string> keys;
  };
  std::vector<std::unique_ptr<Section>> sections_;
  std::optional<Error> first_;
};

/// A table of numbers. A getter that fails stores the first error in the ReadState, which must live as long, and
/// returns zeros. The caller fills its structs and calls ReadState::finish at the end. Coordinates are within ±1000 mm;
/// lengths, radii and widths above 0.
class SectionReader {
 public:
  SectionReader(config::TomlTable table, ReadState& state);

  SectionReader section(std::string_view key);
  std::vector<std::string> keys() const { return section_->table.keys(); }

  float number(std::string_view key) { return numbers<1>(key)[0]; }
  float length(std::string_view key) { return lengths<1>(key)[0]; }
  float degrees(std::string_view key) { return radians(number(key)); }  ///< rad.
  int integer(std::string_view key, config::Range range);
  template <std::size_t kCount>
  std::array<float, kCount> numbers(std::string_view key) {
    return to_array<kCount>(read(key, kCount, kCoordinates));
  }
  template <std::size_t kCount>
  std::array<float, kCount> lengths(std::string_view key) {
    return to_array<kCount>(read(key, kCount, kLengths));
  }
  std::array<double, 3> spreads(std::string_view key);
  Vec3f point(std::string_view key);
  Vec3f radii(std::string_view key);  ///< Three lengths.
  SeedRange range(std::string_view key);
  SeedRange size(std::string_view key);         ///< A range of lengths or factors, above 0.
  Transition transition(std::string_view key);  ///< [from, to]
  Rise rise(std::string_view key);              ///< [height, from, to]
  Rise rise_deg(std::string_view key);          ///< The same with angles.
  Hill hill(std::string_view key);              ///< [height, centre, width]
  Hill hill_deg(std::string_view key);          ///< The same with angles.
  Hill unit_hill(std::string_view key);         ///< [centre, width]; height 1.
  Hill unit_hill_deg(std::string_view key);     ///< The same with angles.
  Ellipse ellipse(std::string_view key);        ///< [x, y, radius, radius]
  Folds folds(std::string_view key);            ///< [distance, depth]
  Knot knot(std::string_view key);              ///< [x, y, z, radius]
  Course course(std::string_view key);          ///< At least two knots.
  std::vector<Cone> cones(std::string_view key);
  /// Rows of `columns` numbers, at least one.
  std::vector<std::vector<double>> rows(std::string_view key, std::size_t columns);

  /// Stores an error of a value that the caller has checked.
  void refuse(std::string_view key, std::string what, std::string advice);

 private:
  static constexpr config::Range kCoordinates{-1000.0, 1000.0};
  static constexpr config::Range kLengths{0.001, 1000.0};
  static constexpr std::size_t kMaxRows = 200;

  static float radians(float degrees);
  template <std::size_t kCount>
  static std::array<float, kCount> to_array(const std::vector<double>& values) {
    std::array<float, kCount> array{};
    for (std::size_t n = 0; n < kCount; ++n) array[n] = static_cast<float>(values[n]);
    return array;
  }

  SeedRange range(std::string_view key, config::Range ends);
  /// Returns `count` numbers; zeros after an error.
  std::vector<double> read(std::string_view key, std::size_t count, config::Range range);
  void check_length(std::string_view key, float value);
  template <class T>
  T take(Result<T> result, T otherwise) {
    if (result) return *std::move(result);
    state_->add(std::move(result).error());
    return otherwise;
  }

  ReadState* state_;
  ReadState::Section* section_;
};

}  // namespace trocar::phantom
