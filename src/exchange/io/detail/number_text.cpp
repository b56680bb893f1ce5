#include "io/detail/number_text.h"

#include "core/text.h"

namespace trocar::io::detail {
namespace {

constexpr std::string_view kWhite = " \t\r\n\f\v";

}  // namespace

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kWhite);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kWhite) - first + 1);
}

std::optional<std::vector<double>> find_numbers(std::string_view text, std::size_t most) {
  std::vector<double> numbers;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    const std::string_view word = text.substr(0, text.find_first_of(kWhite));
    const auto number = parse_number<double>(word);
    if (!number || numbers.size() == most) return std::nullopt;
    numbers.push_back(*number);
    text.remove_prefix(word.size());
  }
  return numbers;
}

Result<ultrasound::TrackedSequence::Matrix4> parse_matrix(std::string_view text) {
  const auto numbers = find_numbers(text, 16);
  if (!numbers || numbers->size() != 16)
    return fail("is not a matrix of 16 finite numbers", "matrix", "give 16 numbers, row by row");
  ultrasound::TrackedSequence::Matrix4 matrix;
  for (int n = 0; n < 16; ++n) matrix(n / 4, n % 4) = (*numbers)[static_cast<std::size_t>(n)];
  if (matrix(3, 0) != 0.0 || matrix(3, 1) != 0.0 || matrix(3, 2) != 0.0 || matrix(3, 3) != 1.0)
    return fail("is not an affine matrix: its last row is not 0 0 0 1", "matrix", "give an affine matrix");
  return matrix;
}

}  // namespace trocar::io::detail
