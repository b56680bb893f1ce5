#include "option.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <limits>
#include <utility>

#include "core/text.h"

namespace trocar::arguments {
namespace {

template <class Number>
struct Range {
  Number low, high;
  const char* kind;  ///< "number", "whole number".
  std::string unit;

  std::string text() const { return fmt::format("{} to {}{}{}", low, high, unit.empty() ? "" : " ", unit); }
  /// NaN is outside every range.
  bool holds(Number number) const { return number >= low && number <= high; }
};

/// Rejects values out of range; rewrites the number in a decimal form that CLI11 can read.
template <class Number>
void restrict_to(CLI::Option& option, Range<Number> range) {
  option.description(fmt::format("{} ({})", option.get_description(), range.text()));
  option.type_name("NUMBER");
  option.transform(CLI::Validator(
      [range = std::move(range)](std::string& text) {
        const auto number = parse_number<Number>(text);
        if (!number || !range.holds(*number))
          return fmt::format("\"{}\" is not a {} from {}", text, range.kind, range.text());
        text = fmt::format("{}", *number);
        return std::string();
      },
      ""));
}

}  // namespace

Option Option::required() {
  option_->required();
  return *this;
}

Option Option::show_default() {
  option_->capture_default_str();
  return *this;
}

Option Option::needs(Option other) {
  option_->needs(other.option_);
  return *this;
}

Option Option::excludes(Option other) {
  option_->excludes(other.option_);
  return *this;
}

Option Option::type_name(const std::string& name) {
  option_->type_name(name);
  return *this;
}

Option Option::existing_file() {
  option_->check(CLI::ExistingFile);
  return *this;
}

Option Option::one_of(std::vector<std::string> words) {
  option_->check(CLI::IsMember(std::move(words)));
  return *this;
}

Option Option::values(int count) {
  option_->expected(count);
  return *this;
}

Option Option::one_value_each() {
  option_->allow_extra_args(false);
  return *this;
}

Option Option::separated_by(char delimiter) {
  option_->delimiter(delimiter);
  return *this;
}

Option Option::number_within(double low, double high, std::string_view unit) {
  restrict_to<double>(*option_, {low, high, "number", std::string(unit)});
  return *this;
}

Option Option::whole_number_within(std::int64_t low, std::int64_t high) {
  restrict_to<std::int64_t>(*option_, {low, high, "whole number", {}});
  return *this;
}

Option Option::seed() {
  restrict_to<std::uint64_t>(*option_, {0, std::numeric_limits<std::uint64_t>::max(), "whole number", {}});
  return *this;
}

const std::vector<std::string>& Option::texts() const {
  return option_->results();
}

std::string Option::name() const {
  return option_->get_name();
}

std::string Option::argument_name() const {
  return option_->get_name(true);
}

std::vector<std::string> Option::dashed_names() const {
  std::vector<std::string> names;
  for (const std::string& name : option_->get_lnames()) names.push_back("--" + name);
  for (const std::string& name : option_->get_snames()) names.push_back("-" + name);
  return names;
}

/// CLI11 writes them into the name of the type: "TEXT:{a,b}".
std::vector<std::string> Option::words() const {
  const std::string type = option_->get_type_name();
  const auto open = type.find('{');
  const auto close = type.find('}', open);
  if (open == std::string::npos || close == std::string::npos) return {};
  std::vector<std::string> words(1);
  for (const char c : type.substr(open + 1, close - open - 1)) {
    if (c == ',') {
      words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  return words;
}

bool Option::is_flag() const {
  return option_->get_items_expected_max() == 0;
}

}  // namespace trocar::arguments
