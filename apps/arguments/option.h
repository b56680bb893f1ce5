#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class Option;
}

namespace trocar::arguments {

/// An option, a flag or an argument of a command. A handle: copies are the same option, which lives as long as its
/// Program. A function that sets a property returns the option, so that calls can be chained.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option required();
  Option show_default();                      ///< The help shows the present value of the variable.
  Option needs(Option other);                 ///< It is a usage error to leave out `other`.
  Option excludes(Option other);              ///< It is a usage error to give `other`, too.
  Option type_name(const std::string& name);  ///< What the help shows instead of "TEXT".
  Option existing_file();
  Option one_of(std::vector<std::string> words);

  // A list takes all texts until the next option, unless one of these is set.
  Option values(int count);             ///< Exactly `count` texts.
  Option one_value_each();              ///< One text each time that the option is given.
  Option separated_by(char delimiter);  ///< A text holds several values.

  // Every option that takes a number uses one of these. Each value must be a decimal number without other text: "",
  // "nan", "inf", "0x10", "3x" and numbers outside the range are usage errors. The help shows the range.

  /// A number from `low` to `high`. `unit` is the usual symbol ("mm", "Hz"); empty for a dimensionless number.
  Option number_within(double low, double high, std::string_view unit);
  /// A whole number from `low` to `high`; a leading zero does not make it octal.
  Option whole_number_within(std::int64_t low, std::int64_t high);
  /// A random seed: a whole number from 0 to 2^64 - 1.
  Option seed();

  bool is_given() const { return !texts().empty(); }
  const std::vector<std::string>& texts() const;  ///< As written; numbers as they were read; "true" for a flag.

  std::string name() const;                       ///< "--seed"; of an argument "NAME".
  std::string argument_name() const;              ///< "NAME"; empty if it is an option only.
  std::vector<std::string> dashed_names() const;  ///< "--verbose", then "-v"; none for an argument.
  std::vector<std::string> words() const;         ///< Those of one_of().
  bool is_flag() const;

 private:
  CLI::Option* option_;
};

}  // namespace trocar::arguments
